// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/paper/filters.hpp"
#include "shapemap/paper/similarity.hpp"
#include "shapemap/shape/scan_view.hpp"

namespace shapemap {

/// Proposes translations as the paper does: each segment of a longest common subsequence gives its mean translation,
/// and not only the best segment is used. An object is made once for a pair of scans and serves every rotation.
class LcsHypotheses {
 public:
  /// Copies what it needs of both views.
  LcsHypotheses(const ScanView& reference, const ScanView& query);

  /// Returns at most `max_count` translations [m] of the query turned by `rotation_rad`, those of the longest segments
  /// first.
  std::vector<Point2> translations(double rotation_rad, int max_count) const;

 private:
  Shape reference_shape_;
  Shape query_shape_;
  NeighbourDirections query_directions_;
  SimilarityIndex index_;
};

}  // namespace shapemap
