// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "shapemap/core/angles.hpp"
#include "shapemap/core/numbers.hpp"
#include "shapemap/core/pose2.hpp"
#include "shapemap/graph/edge.hpp"

namespace shapemap {

/// Returns the log odds, 0 or more, that a match with these log odds of its own adds to others that support it.
double worth_among_others(double log_odds);

/// Returns the same for a candidate in its cluster.
double worth_of_member(const EdgeCandidate& member);

/// Loop candidates that agree: they match several scans of one stretch of the way to several scans of another, with
/// consistent relative poses.
struct LoopCluster {
  std::vector<EdgeCandidate> members;  ///< most probable first
  double strength = 0.0;               ///< smaller sum of both stretches over the worth of the best member of each node
  std::size_t num_a = 0;               ///< number of distinct nodes in the earlier stretch
  std::size_t num_b = 0;               ///< number of distinct nodes in the later stretch
};

/// These options say which loop candidates make a cluster.
struct ClusterOptions {
  int window = 4;
  PoseTolerance same{0.40, 6 * kDegree};
  int least_nodes = 2;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"window", "matches support each other between nodes so near along the way, on both sides",
                      "set by hand: scans so near still see much the same"},
          self.window);
    visit(NumberField{"same", "and when they agree to this; so must the matches of two submaps",
                      "set by hand: the error of two matches and of the way between them"},
          self.same);
    visit(NumberField{"least_nodes", "a cluster has so many nodes on either side",
                      "set by hand: it must not hang on one scan"},
          self.least_nodes);
  }
};

/// Returns the clusters of `candidates`, strongest first. `map_from_node` has the poses by odometry edges, which are
/// trusted only within a submap. A candidate that no other one supports makes no cluster.
std::vector<LoopCluster> loop_clusters(const std::vector<EdgeCandidate>& candidates,
                                       const std::vector<Pose2>& map_from_node,
                                       const std::vector<std::size_t>& submap_of_node, const ClusterOptions& options);

}  // namespace shapemap
