// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "shapemap/align/visibility.hpp"
#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// How well scans that the chain does not join go together at the poses of a map: what one of them saw, the other must
/// not have looked through. A place that is mapped twice, or two places on top of each other, tell against a map;
/// a loop that is closed well tells for it. Logarithm of odds, 0 for a map in which no two stretches meet.
class MapEvidence {
 public:
  MapEvidence(std::vector<std::shared_ptr<const ScanView>> views, VisibilityOptions options, int threads)
      : views_(std::move(views)), options_(options), threads_(threads) {}

  double of(const std::vector<Pose2>& map_from_node);

  /// Of one pair of scans.
  static double of_pair(const Visibility& visibility);

 private:
  /// Of a pair, where it was last asked for.
  struct Known {
    Pose2 a_from_b;
    double value = 0.0;
  };

  std::vector<std::shared_ptr<const ScanView>> views_;
  VisibilityOptions options_;
  int threads_;
  std::map<std::pair<std::size_t, std::size_t>, Known> known_;
};

/// Pairs of nodes nearer than `within_m` to each other, the earlier one first, in order.
std::vector<std::pair<std::size_t, std::size_t>> near_pairs(const std::vector<Pose2>& map_from_node, double within_m);

}  // namespace shapemap
