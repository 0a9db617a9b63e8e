// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/core/angles.hpp"
#include "shapemap/core/numbers.hpp"
#include "shapemap/core/pose2.hpp"

/// The numbers of the keyframe graph and of its solver.
namespace shapemap {

struct StepNumbers {
  double usual_slip_m = 0.5;
  double usual_slip_rad = 180 * kDegree;
  double certain = 0.98;
  double sure = 0.9;
  double held_m = 0.2;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"usual_slip_m", "where no motion is expected, a step is what its scans say, give or take this",
                      "set by hand: a corridor must not shrink because its scans slide"},
          self.usual_slip_m);
    visit(NumberField{"usual_slip_rad", "and give or take this turn", "nothing is known of a turn beforehand"},
          self.usual_slip_rad);
    visit(
        NumberField{"certain", "edges that are at least so probable teach how the sensor moves",
                    "set by hand: a wrong one would be learned; higher than `sure`, which only a median follows from"},
        self.certain);
    visit(NumberField{"sure", "edges that are more probable tell the usual length of a step",
                      "set by hand: nine of ten of them at least are right, and the median needs no more"},
          self.sure);
    visit(
        NumberField{"held_m", "a match whose place is held worse, in some direction, does not tell where the place is",
                    "set by hand: along a bare corridor, any place will do; loops and the learned motion ask for it"},
        self.held_m);
  }
};

struct SamePlaceNumbers {
  double near_m = 0.1;
  double heading_rad = 10 * kDegree;
  double deviations = 3.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"near_m", "places are the same when so near, in standard deviations, however well they are held",
                      "set by hand: places that are held to a millimetre are not told apart by one"},
          self.near_m);
    visit(NumberField{"heading_rad", "poses that are turned by more are never the same place",
                      "set by hand: scans hold a heading even where they slide"},
          self.heading_rad);
    visit(NumberField{"deviations", "so many standard deviations apart, two poses are different places",
                      "nearly all of a normal distribution lies within three"},
          self.deviations);
  }
};

struct EdgeSupportNumbers {
  double little = 1.2;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"little", "evidence of this sum for and against counts half of what much evidence does",
                      "doubtful edges of thinned orebro, belgioioso, aces and csail and of simulated arenas 0-79, with "
                      "the weights of the verification: scripts/evaluate.py fit-edges"},
          self.little);
  }
};

struct SolverNumbers {
  double function_tolerance = 1e-5;
  double lever_m = 5.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"function_tolerance", "the solver stops when a step lowers the cost by a smaller share",
                      "set by hand, for speed"},
          self.function_tolerance);
    visit(
        NumberField{"lever_m", "a radian of uncertainty costs as much as so many metres where the surest way is sought",
                    "set by hand: a turn shifts what lies so far away by as much"},
        self.lever_m);
  }
};

struct GraphNumbers {
  StepNumbers steps;
  SamePlaceNumbers same_place;
  EdgeSupportNumbers edge_support;
  SolverNumbers solver;

  /// Calls `visit(name, title, group)` for each group; `group` is a struct with `fields`.
  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("steps", "Steps from keyframe to keyframe", self.steps);
    visit("same_place", "Whether two poses are one place, as far as scans hold them", self.same_place);
    visit("edge_support", "What all other scans say of an edge", self.edge_support);
    visit("solver", "The pose graph", self.solver);
  }
};

inline constexpr GraphNumbers kGraph{};

}  // namespace shapemap
