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

/// How much surface runs in which direction: bins of 1 degree.
inline constexpr std::size_t kTangentBins = 360;
using TangentHistogram = std::array<double, kTangentBins>;

/// All that robust alignment needs of one position, in the robot's frame, computed once: shape points at constant arc
/// length, what each beam ended at, and the histogram of tangents. Hypotheses turn and shift it, and never rebuild it.
struct ScanView {
  std::vector<ShapePoint> points;  ///< by place along the scan
  std::vector<Point2> directions;  ///< unit vectors along their tangents

  /// Small where much surface runs the same way: the walls of a corridor say little.
  std::vector<double> weights;
  /// Large for surfaces across the direction that most of the scan runs in: the end of a corridor.
  std::vector<double> cross_weights;

  std::vector<RangeImage> images;  ///< one per sub-scan
  TangentHistogram tangents{};     ///< smoothed over a few degrees
  PointIndex index{{}};            ///< of `points`
  double reach_m = 0.0;            ///< nine of ten returns are nearer
  double seen_share = 0.0;         ///< of all directions from the sensor, those with a surface

  std::size_t size() const { return points.size(); }
};

/// Whether there is hardly a direction that the scan does not see.
bool looks_all_round(const ScanView& view);

/// Never fails: a position without returns has no points.
ScanView view_of(const Scan& scan, const ReturnOptions& returns, const PolylineOptions& polylines,
                 const ShapeOptions& shape, const ViewOptions& options);

}  // namespace shapemap
