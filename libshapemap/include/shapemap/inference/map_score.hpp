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

/// Rates how well scans that no odometry edge joins fit each other at the poses of a map. What one scan saw, the other
/// must not have looked through. So a place that is mapped twice, or two places that lie on each other, speak against a
/// map. A well closed loop speaks for it, but passing the place more often adds little. The score is a logarithm of
/// odds, and 0 for a map in which no two stretches meet.
class MapScore {
 public:
  MapScore(std::vector<std::shared_ptr<const ScanView>> views, VisibilityOptions options, int threads)
      : views_(std::move(views)), options_(options), threads_(threads) {}

  /// Returns the score of a map. Nodes that loops hold to each other have the same `ring_of_node`. Other nodes far
  /// apart along the trajectory count less, because the odometry between them has bent. Without `ring_of_node`, all
  /// pairs count in full.
  double of(const std::vector<Pose2>& map_from_node, const std::vector<std::size_t>& ring_of_node = {});

  /// Returns the score of the pairs of a node of `f` and a node of `g`, where `f` and `g` are submaps with a frame
  /// each. It is estimated from a part of the pairs where there are many.
  double between(const std::vector<Pose2>& pose_in_submap, const std::vector<std::size_t>& f,
                 const std::vector<std::size_t>& g, const Pose2& f_from_g);

  /// Returns the score of one pair of scans.
  static double of_pair(const Visibility& visibility);

 private:
  /// The score of a pair at the relative pose for which it was computed last.
  struct Known {
    Pose2 a_from_b;
    double value = 0.0;
  };

  struct RelativePose {
    std::size_t a;
    std::size_t b;  ///< the later node
    Pose2 a_from_b;
    double counts = 1.0;
  };
  double of_pairs(const std::vector<RelativePose>& pairs, double each_stands_for = 1.0);

  std::vector<std::shared_ptr<const ScanView>> views_;
  VisibilityOptions options_;
  int threads_;
  std::unordered_map<std::size_t, Known> known_;  ///< the key is computed from both nodes of a pair
};

/// Returns the pairs of nodes that are less than `within_m` apart, in order, with the earlier node of each first.
std::vector<std::pair<std::size_t, std::size_t>> near_pairs(const std::vector<Pose2>& map_from_node, double within_m);

}  // namespace shapemap
