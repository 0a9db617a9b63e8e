// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/range_image.hpp"

#include <algorithm>
#include <cmath>

#include "shapemap/scan/returns.hpp"

namespace shapemap {
namespace {

/// A point farther from its segment than this is not on it: its surface is taken to face the sensor.
constexpr double kOnSegment_m = 0.10;

/// Beams that graze a surface leave a footprint of at most this many times their width.
constexpr double kLongestFootprint = 10.0;

double first_bearing_rad(const SubScan& sub_scan) {
  const double first_rad = sub_scan.beam_angle_rad(0);
  const double last_rad = sub_scan.beam_angle_rad(sub_scan.ranges_m.size() - 1);
  const bool upside_down = is_upside_down(sub_scan.robot_from_sensor);  // its angles run clockwise, seen from above
  return wrap_angle(upside_down ? std::min(-first_rad, -last_rad) : std::min(first_rad, last_rad));
}

Point2 normal_at(const SubScanShape& shape, std::size_t point, const Point2& to_sensor) {
  const int closest = shape.polylines.closest_segment[point];
  if (closest < 0) return to_sensor;
  const LineSegment& segment = shape.polylines.segments[static_cast<std::size_t>(closest)];
  if (segment.distance_m(shape.scan_points[point].p_m) > kOnSegment_m) return to_sensor;
  const Point2 along = segment.direction();
  return {-along.y(), along.x()};  // counterclockwise scans have the sensor to their left
}

}  // namespace

int RangeImage::beam_at(double bearing_rad) const {
  const double per_rad = 1.0 / step_rad;
  const double beams_in_turn = 2.0 * kPi * per_rad;
  double from_first_rad = bearing_rad - first_bearing_rad;
  if (std::abs(from_first_rad) > 2.0 * kPi) from_first_rad = wrap_angle(from_first_rad);
  double beam = from_first_rad * per_rad + 0.5;  // less than a turn away: once is enough
  if (beam < 0.0) beam += beams_in_turn;
  if (beam >= beams_in_turn) beam -= beams_in_turn;
  const auto count = static_cast<double>(beams.size());
  if (beam < count) return static_cast<int>(beam);
  // Rounding leaves no gap in a full circle.
  return beams_in_turn - count < 1e-6 ? static_cast<int>(beams.size()) - 1 : -1;
}

RangeImage range_image(const SubScan& sub_scan, const SubScanShape& shape) {
  RangeImage image;
  const Pose2 robot_from_sensor = robot_from_sensor2(sub_scan);
  image.sensor_from_robot = inverse(robot_from_sensor);
  image.step_rad = std::abs(sub_scan.angle_step_rad);
  if (sub_scan.ranges_m.empty() || !(image.step_rad > 0.0)) return image;
  image.first_bearing_rad = first_bearing_rad(sub_scan);
  image.beams.resize(sub_scan.ranges_m.size());
  for (std::size_t i = 0; i < shape.scan_points.size(); ++i) {
    const Point2& hit_m = shape.scan_points[i].p_m;
    const Point2 in_sensor_m = image.sensor_from_robot * hit_m;
    const int k = image.beam_at(std::atan2(in_sensor_m.y(), in_sensor_m.x()));
    if (k < 0) continue;
    RangeImage::Beam& beam = image.beams[static_cast<std::size_t>(k)];
    beam.range_m = in_sensor_m.norm();
    beam.hit_m = hit_m;
    const Point2 to_sensor = (robot_from_sensor.translation() - hit_m) / beam.range_m;
    beam.normal = normal_at(shape, i, to_sensor);
    const double incidence = std::max(1.0 / kLongestFootprint, std::abs(beam.normal.dot(to_sensor)));
    beam.footprint_m = 0.5 * beam.range_m * image.step_rad / incidence;
  }
  return image;
}

}  // namespace shapemap
