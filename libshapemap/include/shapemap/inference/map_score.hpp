// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/matching/visibility.hpp"

namespace shapemap {

/// How well scans that the chain does not join go together at the poses of a map: what one of them saw, the other must
/// not have looked through. A place that is mapped twice, or two places on top of each other, tell against a map;
/// a loop that is closed well tells for it, though not the more, the more often the place is passed. Logarithm of odds,
/// 0 for a map in which no two stretches meet.
class MapScore {
 public:
  MapScore(std::vector<std::shared_ptr<const ScanView>> views, VisibilityOptions options, int threads)
      : views_(std::move(views)), options_(options), threads_(threads) {}

  /// `ring_of_node` tells nodes that loops hold to each other. Of all others, a long chain has bent, and whether they
  /// go together at the poses of the map tells little; without it, all are held.
  double of(const std::vector<Pose2>& map_from_node, const std::vector<std::size_t>& ring_of_node = {});

  /// Of the pairs of which one node is in `f` and the other in `g`, two pieces with a frame each. Estimated from a part
  /// of them where they are many.
  double between(const std::vector<Pose2>& pose_in_submap, const std::vector<std::size_t>& f,
                 const std::vector<std::size_t>& g, const Pose2& f_from_g);

  /// Of one pair of scans.
  static double of_pair(const Visibility& visibility);

 private:
  /// Of a pair, where it was last asked for.
  struct Known {
    Pose2 a_from_b;
    double value = 0.0;
  };

  struct RelativePose {
    std::size_t a;
    std::size_t b;  ///< the later one
    Pose2 a_from_b;
    double counts = 1.0;
  };
  double of_pairs(const std::vector<RelativePose>& pairs, double each_stands_for = 1.0);

  std::vector<std::shared_ptr<const ScanView>> views_;
  VisibilityOptions options_;
  int threads_;
  std::unordered_map<std::size_t, Known> known_;  ///< by both numbers of a pair
};

/// Pairs of nodes nearer than `within_m` to each other, the earlier one first, in order.
std::vector<std::pair<std::size_t, std::size_t>> near_pairs(const std::vector<Pose2>& map_from_node, double within_m);

}  // namespace shapemap
