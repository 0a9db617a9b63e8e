// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"
#include "shapemap/shape/polyline_em.hpp"

/// Paper, section II: the shape of a scan, which is all that alignment looks at.
namespace shapemap {

/// Which points carry the shape.
enum class ShapePoints {
  kResampled,  ///< points at equal arc length along the polylines: the same surface has the same shape at any range
  kBeams,      ///< the scan points themselves, as in the paper
};

template <>
struct EnumNames<ShapePoints> {
  static constexpr std::array<std::string_view, 2> names{"resampled", "beams"};
};

struct ShapeOptions {
  ShapePoints points = ShapePoints::kResampled;
  double spacing_m = 0.05;
  int min_points = 10;
  int max_points = 20000;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"shape-points", "points that carry the shape"}, self.points);
    visit(Field{"shape-spacing-m", "arc length between resampled points [m]", 0.005, 1}, self.spacing_m);
    visit(Field{"shape-min-points", "a scan with fewer shape points is not aligned", 3, 100000}, self.min_points);
    visit(Field{"shape-max-points", "of a scan with more points, only every second, third, ... is used", 100, 1000000},
          self.max_points);
  }
};

/// An ordered point with the direction of the polyline there.
struct ShapePoint {
  Point2 p_m{0.0, 0.0};
  double tangent_rad = 0.0;  ///< 0 to 360 degrees: oriented along the scan order (counterclockwise about the sensor)
  int sweep = 0;             ///< index into Position::sweeps
};

/// The ordered shape points of one position, in the robot's frame: sub-scan after sub-scan, each counterclockwise.
struct Shape {
  std::vector<ShapePoint> points;
  int num_sweeps = 0;

  std::size_t size() const { return points.size(); }
};

/// Polylines of one sub-scan (kept for figures) and the shape points that follow from them.
struct SweepShape {
  std::vector<ScanPoint> scan_points;
  PolylineFit polylines;
  std::vector<ShapePoint> shape_points;
};

SweepShape sweep_shape(const Sweep& sweep, int sweep_index, const ReturnOptions& returns,
                       const PolylineOptions& polylines, const ShapeOptions& options);

/// The whole position. Never fails: a position without returns has no points.
Shape shape_of(const Scan& scan, const ReturnOptions& returns, const PolylineOptions& polylines,
               const ShapeOptions& options);

/// The same shape seen from another frame; `sweep_poses` (one per sub-scan, or empty) are applied first.
Shape moved(const Shape& shape, const Pose2& b_from_a, const std::vector<Pose2>& sweep_poses = {});

}  // namespace shapemap
