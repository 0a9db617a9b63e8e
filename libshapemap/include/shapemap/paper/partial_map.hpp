// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "shapemap/shape/angular_histogram.hpp"
#include "shapemap/shape/point_index.hpp"
#include "shapemap/shape/shape.hpp"

/// Paper, section II-C: the partial global map, of a few recent scans, that a query scan is aligned to.
namespace shapemap {

/// A scan that query scans are aligned to. What is slow to compute, the directions between its points, is shared by all
/// the partial maps that it is part of, however it is turned there.
struct TargetScan {
  Shape shape;  ///< in the frame of the partial map
  std::shared_ptr<const NeighbourDirections> directions;
  double turned_rad = 0.0;  ///< of `shape` since `directions` were computed
};

/// Computes those directions, up to the radius of the angular histograms.
TargetScan target_scan(Shape shape, double histogram_radius_m);

/// Moves a scan to another frame.
TargetScan moved(const TargetScan& scan, const Pose2& b_from_a);

/// A few recent scans at their estimated poses, all in the frame of the reference, which is the latest of them. A
/// partial map is built once for each alignment and not changed by it.
class PartialMap {
 public:
  /// `scans` are already in the reference frame.
  explicit PartialMap(std::vector<TargetScan> scans);

  /// With `as_one_sequence`, the points of all scans, in the order given, are one long sequence for a single LCS; else
  /// each scan is matched on its own.
  PartialMap(const std::vector<Shape>& scans, bool as_one_sequence, double histogram_radius_m);

  const std::vector<TargetScan>& sequences() const { return sequences_; }
  std::size_t num_points() const { return all_points_.size(); }
  const ShapePoint& point(std::size_t i) const { return all_points_[i]; }
  const PointIndex& index() const { return index_; }

 private:
  std::vector<TargetScan> sequences_;
  std::vector<ShapePoint> all_points_;
  PointIndex index_;
};

}  // namespace shapemap
