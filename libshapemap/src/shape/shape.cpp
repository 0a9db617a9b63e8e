// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/shape.hpp"

#include <algorithm>

namespace shapemap {
namespace {

/// Puts points at every `spacing_m` of arc length, the first half a spacing from the start; a short segment gives its
/// middle.
void resample(const LineSegment& segment, int sweep, double spacing_m, std::vector<ShapePoint>& points) {
  const double length_m = segment.length_m();
  const auto count = std::max(1L, std::lround(length_m / spacing_m));
  const Point2 step = (segment.end_m - segment.start_m) / static_cast<double>(count);
  const double tangent_rad = segment.tangent_rad();
  for (long k = 0; k < count; ++k) {
    points.push_back({segment.start_m + (static_cast<double>(k) + 0.5) * step, tangent_rad, sweep});
  }
}

/// Keeps every second, third, ... point, so that at most `max_points` are left: the memory and time of fitting and
/// matching grow with the square of their number.
template <class Point>
void thin_out(std::vector<Point>& points, std::size_t max_points) {
  if (points.size() <= max_points) return;
  const std::size_t step = (points.size() + max_points - 1) / max_points;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); i += step) points[kept++] = points[i];
  points.resize(kept);
}

}  // namespace

SweepShape sweep_shape(const Sweep& sweep, int sweep_index, const ReturnOptions& returns,
                       const PolylineOptions& polylines, const ShapeOptions& options) {
  SweepShape shape;
  std::vector<Return> hits = returns_in_robot(sweep, returns);
  thin_out(hits, static_cast<std::size_t>(options.max_points));
  for (const Return& r : hits) {
    shape.scan_points.push_back({r.p_in_robot_m, r.range_m * std::abs(sweep.angle_step_rad)});
  }
  shape.polylines = fit_polylines(shape.scan_points, polylines);
  if (options.points == ShapePoints::kResampled) {
    for (const LineSegment& segment : shape.polylines.segments) {
      resample(segment, sweep_index, options.spacing_m, shape.shape_points);
    }
    return shape;
  }
  for (std::size_t i = 0; i < shape.scan_points.size(); ++i) {
    const int closest = shape.polylines.closest_segment[i];
    if (closest < 0) continue;
    const double tangent_rad = shape.polylines.segments[static_cast<std::size_t>(closest)].tangent_rad();
    shape.shape_points.push_back({shape.scan_points[i].p_m, tangent_rad, sweep_index});
  }
  return shape;
}

Shape shape_of(const Scan& scan, const ReturnOptions& returns, const PolylineOptions& polylines,
               const ShapeOptions& options) {
  Shape shape;
  shape.num_sweeps = static_cast<int>(scan.sweeps.size());
  for (int s = 0; s < shape.num_sweeps; ++s) {
    const auto part = sweep_shape(scan.sweeps[static_cast<std::size_t>(s)], s, returns, polylines, options);
    shape.points.insert(shape.points.end(), part.shape_points.begin(), part.shape_points.end());
  }
  thin_out(shape.points, static_cast<std::size_t>(options.max_points));
  return shape;
}

Shape moved(const Shape& shape, const Pose2& b_from_a, const std::vector<Pose2>& sweep_poses) {
  Shape result = shape;
  for (ShapePoint& point : result.points) {
    const bool corrected = !sweep_poses.empty();
    const Pose2 pose = corrected ? b_from_a * sweep_poses[static_cast<std::size_t>(point.sweep)] : b_from_a;
    point.p_m = pose * point.p_m;
    point.tangent_rad = wrap_angle(point.tangent_rad + pose.theta_rad);
  }
  return result;
}

}  // namespace shapemap
