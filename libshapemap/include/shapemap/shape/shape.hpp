// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"
#include "shapemap/shape/polyline_em.hpp"

/// The shape of a scan is all that matching uses of it (paper, section II).
namespace shapemap {

/// One of these kinds of points carries the shape.
enum class ShapePoints {
  kResampled,  ///< points at equal arc length along the polylines: a surface has the same shape at any range
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

/// A shape point has the direction of the polyline there.
struct ShapePoint {
  Point2 p_m{0.0, 0.0};
  double tangent_rad = 0.0;  ///< in [0, 2 pi), oriented along the scan order (counterclockwise about the sensor)
  int sweep = 0;             ///< index into Scan::sweeps
};

/// A shape has the ordered points of one scan, in the robot's frame: sweep after sweep, each counterclockwise.
struct Shape {
  std::vector<ShapePoint> points;
  int num_sweeps = 0;

  std::size_t size() const { return points.size(); }
};

/// The shape points of a sweep follow from its polylines, which are kept for figures.
struct SweepShape {
  std::vector<ScanPoint> scan_points;
  PolylineFit polylines;
  std::vector<ShapePoint> shape_points;
};

SweepShape sweep_shape(const Sweep& sweep, int sweep_index, const ReturnOptions& returns,
                       const PolylineOptions& polylines, const ShapeOptions& options);

/// Computes the shape of a whole scan. This never fails: a scan without returns has no points.
Shape shape_of(const Scan& scan, const ReturnOptions& returns, const PolylineOptions& polylines,
               const ShapeOptions& options);

/// Returns the same shape seen from another frame; `sweep_poses` (one per sweep, or empty) are applied first.
Shape moved(const Shape& shape, const Pose2& b_from_a, const std::vector<Pose2>& sweep_poses = {});

}  // namespace shapemap
