// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/core/angles.hpp"
#include "shapemap/core/numbers.hpp"
#include "shapemap/loops/loop_clusters.hpp"

/// The numbers of how loops are found, and of what they are worth.
namespace shapemap {

struct DescriptorNumbers {
  double distance_bin_m = 0.75;
  double least_distance_m = 0.30;
  std::size_t most_points = 150;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"distance_bin_m", "the width of a bin of the distances between points",
                      "set by hand: twelve bins reach nine metres far"},
          self.distance_bin_m);
    visit(NumberField{"least_distance_m", "nearer points are not compared", "they lie on the same surface"},
          self.least_distance_m);
    visit(NumberField{"most_points", "of a scan with twice as many points only every second is used, and so on",
                      "set by hand, for speed: the time grows with the square"},
          self.most_points);
  }
};

struct DetectionNumbers {
  std::size_t poses_per_pair = 3;
  std::size_t poses_per_cross_edge_pair = 5;
  std::size_t cross_edge_nodes = 4;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"poses_per_pair", "candidates of a pair of scans that may close a loop",
                      "set by hand: at a place that looks like others the best candidate is not always right"},
          self.poses_per_pair);
    visit(NumberField{"poses_per_cross_edge_pair", "candidates of a pair of scans on both sides of a doubtful edge",
                      "set by hand: more than for loops, as few pairs have to tell"},
          self.poses_per_cross_edge_pair);
    visit(NumberField{"cross_edge_nodes", "keyframes on either side of a doubtful edge that are matched to each other",
                      "set by hand: as many as a cluster spans, see `clusters.window`, but it says how far scans still "
                      "see the same"},
          self.cross_edge_nodes);
  }
};

struct MemberNumbers {
  double prior = 2.0;
  double most = 6.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"prior", "is added to the log odds of a match that others may support",
                      "set by hand: the probability of a match allows for scans of different places, which neighbours "
                      "are not, and one that is improbable by itself still supports the others"},
          self.prior);
    visit(NumberField{"most", "what a match can be worth at most, as log odds",
                      "set by hand: two matches of neighbouring scans share most of what they saw, and are no "
                      "independent witnesses"},
          self.most);
  }
};

struct AliasingNumbers {
  PoseTolerance contradicts{2.0, 30 * kDegree};
  double deviations = 4.0;
  std::size_t long_chain = 40;
  std::size_t near = 2;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"contradicts", "what odometry contradicts is off by more than this",
                      "set by hand: as far as sure edges can be off together; wider than the tolerances of inference"},
          self.contradicts);
    visit(
        NumberField{"deviations", "and by so many standard deviations more", "set by hand: rather too few than wrong"},
        self.deviations);
    visit(NumberField{"long_chain", "so many edges in a row that no loop holds are not all right",
                      "set by hand: at 0.97 each, all forty are right with a probability of 0.3; what lies farther "
                      "apart contradicts nothing here, and tells less of a map in MapScore"},
          self.long_chain);
    visit(NumberField{"near", "keyframes so near to one that looks like another place look alike as well",
                      "set by hand: smaller than the windows of clusters, as it takes odds away"},
          self.near);
  }
};

struct ConflictNumbers {
  double least_strength = 1.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"least_strength", "weaker conflicts of two clusters are of no account",
                      "set by hand, for speed: they would change little"},
          self.least_strength);
  }
};

struct LoopsNumbers {
  DescriptorNumbers descriptor;
  DetectionNumbers detection;
  ClusterOptions clusters;
  MemberNumbers members;
  AliasingNumbers aliasing;
  ConflictNumbers conflicts;

  /// Calls `visit(name, title, group)` for each group; `group` is a struct with `fields`.
  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("descriptor", "Which places look alike", self.descriptor);
    visit("detection", "Matches that may close a loop", self.detection);
    visit("clusters", "Matches that say the same", self.clusters);
    visit("members", "What a match is worth among others", self.members);
    visit("aliasing", "Places that look like others", self.aliasing);
    visit("conflicts", "Clusters that contradict each other", self.conflicts);
  }
};

inline constexpr LoopsNumbers kLoops{};

}  // namespace shapemap
