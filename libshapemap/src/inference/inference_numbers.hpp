// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "objective_numbers.hpp"
#include "shapemap/core/angles.hpp"
#include "shapemap/core/numbers.hpp"
#include "shapemap/core/pose2.hpp"

/// The numbers of which map is right: what a map is worth, and how a better one is sought.
namespace shapemap {

struct SearchNumbers {
  int assemblies_in_vain = 3;
  double least_gain_share = 0.01;
  int closing_rounds = 3;
  double joining_strength = 18.0;
  std::size_t joining_nodes = 3;
  double joining_lead = 2.0;
  double strong_loop = 10.0;
  double very_doubtful = 0.65;
  int repair_rounds = 4;
  std::size_t doubtful_per_loop = 4;
  double hopeless_edge = 30.0;
  double hopeless_loop = 200.0;
  double trusted = 0.5;
  double components_apart_m = 1e4;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"assemblies_in_vain", "no more maps are assembled when so many in a row are no better",
                      "set by hand, for speed"},
          self.assemblies_in_vain);
    visit(NumberField{"least_gain_share", "better is one that is worth more by this share", "set by hand, for speed"},
          self.least_gain_share);
    visit(NumberField{"closing_rounds", "rounds in which all loops are tried", "set by hand, for speed"},
          self.closing_rounds);
    visit(NumberField{"joining_strength", "a loop that alone says where two submaps lie must be so strong",
                      "set by hand: some places look alike, and nothing else tells; `strong_loop` is for loops that "
                      "only make edges doubtful"},
          self.joining_strength);
    visit(NumberField{"joining_nodes", "and must come from so many nodes of each",
                      "set by hand: it must not hang on one scan"},
          self.joining_nodes);
    visit(NumberField{"joining_lead", "and be so many times as strong as one that would join them otherwise",
                      "set by hand: of two places that look alike neither may decide"},
          self.joining_lead);
    visit(NumberField{"strong_loop", "a loop so strong that does not fit makes the edges along it doubtful",
                      "set by hand, for speed: each is tried"},
          self.strong_loop);
    visit(NumberField{"very_doubtful", "edges less probable than this share of --loop-doubt-below are repaired first",
                      "set by hand: a wrong loop that needs a better edge cut must not get in their way"},
          self.very_doubtful);
    visit(NumberField{"repair_rounds", "rounds of repairs", "set by hand, for speed"}, self.repair_rounds);
    visit(NumberField{"doubtful_per_loop", "edges that are tried along a loop that does not fit",
                      "set by hand, for speed"},
          self.doubtful_per_loop);
    visit(NumberField{"hopeless_edge",
                      "another candidate is not pursued when the map is so much worse before loops "
                      "follow",
                      "set by hand, for speed"},
          self.hopeless_edge);
    visit(NumberField{"hopeless_loop", "nor a loop that is closed by force, or an edge that was changed before",
                      "set by hand: wider, as the map swings farther"},
          self.hopeless_loop);
    visit(NumberField{"trusted", "edges at least so probable hold their nodes well enough to compare loops",
                      "set by hand: a wrong one only parts clusters; it equals --cross-match-below, which decides "
                      "something else: where matches across an edge are sought"},
          self.trusted);
    visit(NumberField{"components_apart_m", "components of a map that nothing joins lie so far apart",
                      "no scan sees so far"},
          self.components_apart_m);
  }
};

struct MergingNumbers {
  std::size_t most_ways = 16;
  std::size_t ways_tried = 4;
  double least_weight = 0.1;
  double size_m2 = 4.0;
  double revisit_penalty = 10.0;
  double revisit_penalty_per_log_step = 2.0;
  double most_longer = 10.0;
  double noise = 4.0;
  int iterations = 10;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"most_ways", "alignments of two submaps that are put up",
                      "set by hand: further ones start from matches that are worth little"},
          self.most_ways);
    visit(NumberField{"ways_tried", "those of them of which the scans are compared", "set by hand, for speed"},
          self.ways_tried);
    visit(NumberField{"least_weight", "what a match counts for in the mean of several, beside what it is worth",
                      "set by hand: some are worth nothing"},
          self.least_weight);
    visit(NumberField{"size_m2", "the square of the distance at which a scan's heading counts as much as its place",
                      "set by hand, as if a scan were two metres large"},
          self.size_m2);
    visit(NumberField{"revisit_penalty", "log odds against a submap being elsewhere than odometry goes on",
                      "set by hand: of places of which nothing is known, some look alike"},
          self.revisit_penalty);
    visit(NumberField{"revisit_penalty_per_log_step", "and more for the logarithm of the steps between the two",
                      "set by hand: the longer the way, the more places there are"},
          self.revisit_penalty_per_log_step);
    visit(NumberField{"most_longer", "a step that is so many times longer than usual costs the most",
                      "set by hand; the objective allows for more (`objective.most_unusual`)"},
          self.most_longer);
    visit(NumberField{"noise", "what an alignment gains or loses by chance, at most, in all variants but the first",
                      "set by hand: enough for other decisions early on"},
          self.noise);
    visit(NumberField{"iterations", "iterations of the solver for a submap",
                      "set by hand, for speed: it is solved for again when it has grown"},
          self.iterations);
  }
};

struct RefinementNumbers {
  double m_per_rad = 1.5;
  double loss = 1.5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"m_per_rad", "a turn counts as so many metres where the nearest neighbours are chosen",
                      "set by hand: scans that look elsewhere share less of what they see"},
          self.m_per_rad);
    visit(NumberField{"loss", "beyond so many standard deviations a neighbour counts less and less",
                      "set by hand: tighter than `agreement.match_loss`, as each node has several neighbours"},
          self.loss);
  }
};

struct SweepRefinementNumbers {
  double noise_residual_m = 0.012;
  double noise_tangent = 0.03;
  double known_slack = 5.0;
  double first_gate = 4.0;
  double gate_shrinks = 0.7;
  double stiffness = 0.002;
  PoseTolerance most_off{0.30, 4 * kDegree};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"noise_residual_m", "spread of a point about its line, of two sweeps",
                      "set by hand: that of whole scans (`matching.line_noise`) is larger and holds the errors of "
                      "their sweeps as well"},
          self.noise_residual_m);
    visit(NumberField{"noise_tangent", "and the noise of its tangent", "set by hand, as the spread"},
          self.noise_tangent);
    visit(NumberField{"known_slack", "what whole scans say has so many times the standard deviation",
                      "set by hand: it only holds what sweeps leave free"},
          self.known_slack);
    visit(NumberField{"first_gate", "the gate of the first round, in gates of the last",
                      "set by hand: partners are sought in a wide gate first"},
          self.first_gate);
    visit(NumberField{"gate_shrinks", "what is left of the gate after a round", "set by hand"}, self.gate_shrinks);
    visit(NumberField{"stiffness", "resistance to sliding along lines, as a share of the partners",
                      "set by hand: less than --line-stiffness, as all poses are solved for at once"},
          self.stiffness);
    visit(NumberField{"most_off", "a match of two sweeps farther from the map does not count",
                      "set by hand: they have found other surfaces"},
          self.most_off);
  }
};

struct InferenceNumbers {
  AgreementNumbers agreement;
  MapScoreWeights map_score_weights;
  MapScoreNumbers map_score;
  ObjectiveNumbers objective;
  SearchNumbers search;
  MergingNumbers merging;
  VerificationNumbers verification;
  VerificationWeights verification_weights;
  RefinementNumbers refinement;
  SweepRefinementNumbers sweeps;

  /// Calls `visit(name, title, group)` for each group; `group` is a struct with `fields`.
  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("agreement", "What is the same place, stretch or agreement", self.agreement);
    visit("map_score_weights", "What two scans of a map are worth", self.map_score_weights);
    visit("map_score", "Which scans of a map are compared", self.map_score);
    visit("objective", "The value of a map", self.objective);
    visit("search", "The search for a better map", self.search);
    visit("merging", "Submaps that are laid together", self.merging);
    visit("verification", "Which scans verify a doubtful edge", self.verification);
    visit("verification_weights", "What a candidate of a doubtful edge is worth", self.verification_weights);
    visit("refinement", "The refinement of the whole map", self.refinement);
    visit("sweeps", "The refinement of sweeps", self.sweeps);
  }
};

inline constexpr InferenceNumbers kInference{};

}  // namespace shapemap
