// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/shape/angular_histogram.hpp"
#include "shapemap/shape/point_index.hpp"
#include "shapemap/shape/shape.hpp"

namespace shapemap {

/// A few recent scans at their estimated poses, all in the frame of the reference (the latest of them): what a query is
/// aligned to (paper, section II-C). Built once per alignment and not changed by it.
class PartialMap {
 public:
  /// `scans` are already in the reference frame. With `as_one_sequence`, all scans are one long sequence of points, in
  /// the order given, for a single LCS; else each scan is matched on its own.
  PartialMap(std::vector<Shape> scans, bool as_one_sequence, double histogram_radius_m);

  const std::vector<Shape>& sequences() const { return sequences_; }
  const std::vector<NeighbourDirections>& directions() const { return directions_; }

  std::size_t num_points() const { return all_points_.size(); }
  const ShapePoint& point(std::size_t i) const { return all_points_[i]; }
  const PointIndex& index() const { return index_; }

 private:
  std::vector<Shape> sequences_;
  std::vector<NeighbourDirections> directions_;
  std::vector<ShapePoint> all_points_;
  PointIndex index_;
};

}  // namespace shapemap
