// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/shape/point_index.hpp"
#include "shapemap/shape/range_image.hpp"
#include "shapemap/shape/shape.hpp"

namespace shapemap {

struct ViewOptions {
  int max_points = 240;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(
        Field{"view-max-points", "shape points of a scan that are compared, spread evenly over its surfaces", 20, 5000},
        self.max_points);
  }
};

/// A tangent histogram tells how much surface runs in which direction, in bins of 1 degree.
inline constexpr std::size_t kTangentBins = 360;
using TangentHistogram = std::array<double, kTangentBins>;

/// Everything that scan matching needs of one scan, in the robot's frame, computed once: shape points at constant arc
/// length, the surface that each beam ended at, and the histogram of tangents. Match candidates turn and shift the
/// view, and never rebuild it.
struct ScanView {
  std::vector<ShapePoint> points;  ///< ordered along the scan
  std::vector<Point2> directions;  ///< unit vectors along the tangents of the points

  /// The weight of a point is small where much surface runs the same way, since the walls of a corridor say little.
  std::vector<double> weights;
  /// The cross weight is large for surfaces across the main direction of the scan, such as the end of a corridor.
  std::vector<double> cross_weights;

  std::vector<RangeImage> images;  ///< one per sweep
  TangentHistogram tangents{};     ///< smoothed over a few degrees
  PointIndex index{{}};            ///< index of `points`
  double reach_m = 0.0;            ///< nine of ten returns are nearer
  double seen_share = 0.0;         ///< share of all directions from the sensor in which a surface was seen

  std::size_t size() const { return points.size(); }
};

/// Says whether the field of view is nearly a full circle.
bool looks_all_round(const ScanView& view);

/// Computes the view of a scan. This never fails: a scan without returns has no points.
ScanView view_of(const Scan& scan, const ReturnOptions& returns, const PolylineOptions& polylines,
                 const ShapeOptions& shape, const ViewOptions& options);

}  // namespace shapemap
