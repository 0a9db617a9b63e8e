// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/paper/filters.hpp"
#include "shapemap/paper/similarity.hpp"
#include "shapemap/shape/scan_view.hpp"

namespace shapemap {

/// Translations by the paper's own means: all segments of a longest common subsequence, each by its mean, and not only
/// the best of them. Made once for a pair and used for every rotation.
class LcsHypotheses {
 public:
  /// Keeps references to both.
  LcsHypotheses(const ScanView& reference, const ScanView& query);

  /// Translations of the query turned by `rotation_rad`, those of the longest segments first.
  std::vector<Point2> translations(double rotation_rad, int max_count) const;

 private:
  Shape reference_shape_;
  Shape query_shape_;
  NeighbourDirections query_directions_;
  SimilarityIndex index_;
};

}  // namespace shapemap
