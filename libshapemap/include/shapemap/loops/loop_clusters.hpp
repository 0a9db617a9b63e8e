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

/// What a match counts for that others may support, by its own log odds: as logarithm of odds, never negative.
double worth_among_others(double log_odds);

/// The same of a candidate in its cluster.
double worth_of_member(const EdgeCandidate& member);

/// Hypotheses that say the same: several scans of one stretch of the way lie so about several of another.
struct LoopCluster {
  std::vector<EdgeCandidate> members;  ///< most probable first
  double strength = 0.0;               ///< log odds of the best member of each node, summed
  std::size_t num_a = 0;               ///< distinct nodes of the one stretch
  std::size_t num_b = 0;
};

/// What makes a cluster.
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

/// `map_from_node` is the chain, of which only short pieces are trusted: pieces with the same `submap_of_node`.
/// Strongest first. Hypotheses that no other one supports make no cluster.
std::vector<LoopCluster> loop_clusters(const std::vector<EdgeCandidate>& candidates,
                                       const std::vector<Pose2>& map_from_node,
                                       const std::vector<std::size_t>& submap_of_node, const ClusterOptions& options);

}  // namespace shapemap
