// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/returns.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

Eigen::Matrix3d rotation_of(const MountPose& mount) {
  return (Eigen::AngleAxisd(mount.yaw_rad, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(mount.pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(mount.roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// Uneven beams come in any order. Equal angles keep the order of the readings.
void sort_by_angle(const Sweep& sweep, std::vector<Return>& returns) {
  std::stable_sort(returns.begin(), returns.end(), [&](const Return& a, const Return& b) {
    return sweep.beam_angles_rad[a.beam] < sweep.beam_angles_rad[b.beam];
  });
}

/// Projects readings of one sweep to the floor plan, in the robot's frame.
class BeamPoints {
 public:
  explicit BeamPoints(const Sweep& sweep)
      : sweep_(sweep),
        robot_from_sensor_(rotation_of(sweep.robot_from_sensor)),
        mount_m_(sweep.robot_from_sensor.x_m, sweep.robot_from_sensor.y_m) {}

  /// Returns the cosine of the angle between the sensor's z axis and the robot's.
  double up() const { return robot_from_sensor_(2, 2); }

  Point2 at(std::size_t beam, double range_m) const {
    const double angle_rad = sweep_.beam_angle_rad(beam);
    const Eigen::Vector3d direction =
        robot_from_sensor_ * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0.0);
    const Point2 p_at_heading = mount_m_ + range_m * direction.head<2>();
    return rotate(p_at_heading, sweep_.nominal_heading_rad);
  }

 private:
  const Sweep& sweep_;
  Eigen::Matrix3d robot_from_sensor_;
  Point2 mount_m_;
};

}  // namespace

bool is_upside_down(const MountPose& robot_from_sensor) { return rotation_of(robot_from_sensor)(2, 2) < 0.0; }

RangeLimits range_limits(const Sweep& sweep, const ReturnOptions& options) {
  RangeLimits limits;
  limits.min_m = options.min_range_m > 0.0 ? options.min_range_m : sweep.min_range_m;
  limits.max_m = options.max_range_m > 0.0 ? options.max_range_m : sweep.max_range_m;
  if (!(limits.max_m > 0.0 && limits.max_m < kLongestRange_m)) limits.max_m = kLongestRange_m;
  return limits;
}

bool is_return(float range_m, const RangeLimits& limits) {
  // The limits are rounded like the readings: a reading of 5.6 is at a maximum of 5.6, although 5.6F < 5.6.
  return std::isfinite(range_m) && range_m > 0.0F && range_m >= static_cast<float>(limits.min_m) &&
         range_m < static_cast<float>(limits.max_m);
}

bool is_open(float range_m, const RangeLimits& limits) {
  if (!std::isfinite(range_m)) return !(range_m < 0.0F);
  return limits.max_m < kLongestRange_m && range_m >= static_cast<float>(limits.max_m);
}

std::vector<Return> returns_in_robot(const Sweep& sweep, const ReturnOptions& options) {
  const BeamPoints points(sweep);
  std::vector<Return> returns;
  if (std::abs(points.up()) < std::cos(options.max_mount_tilt_rad)) return returns;

  const RangeLimits limits = range_limits(sweep, options);
  returns.reserve(sweep.ranges_m.size());
  for (std::size_t beam = 0; beam < sweep.ranges_m.size(); ++beam) {
    const float range_m = sweep.ranges_m[beam];
    if (is_return(range_m, limits)) returns.push_back({points.at(beam, static_cast<double>(range_m)), beam, range_m});
  }
  if (!sweep.is_evenly_spaced()) sort_by_angle(sweep, returns);
  const bool sorted_clockwise = sweep.is_evenly_spaced() && sweep.angle_step_rad < 0.0;
  const bool clockwise_from_above = sorted_clockwise != (points.up() < 0.0);
  if (clockwise_from_above) std::reverse(returns.begin(), returns.end());
  return returns;
}

std::vector<Point2> open_ends_in_robot(const Sweep& sweep, const ReturnOptions& options, double length_m) {
  const BeamPoints points(sweep);
  std::vector<Point2> ends;
  if (std::abs(points.up()) < std::cos(options.max_mount_tilt_rad)) return ends;

  const RangeLimits limits = range_limits(sweep, options);
  for (std::size_t beam = 0; beam < sweep.ranges_m.size(); ++beam) {
    if (!is_open(sweep.ranges_m[beam], limits)) continue;
    ends.push_back(points.at(beam, std::min(length_m, limits.max_m)));
  }
  return ends;
}

Pose2 robot_from_sensor2(const Sweep& sweep) {
  const Eigen::Vector3d forward = rotation_of(sweep.robot_from_sensor) * Eigen::Vector3d::UnitX();
  const Point2 mount_m(sweep.robot_from_sensor.x_m, sweep.robot_from_sensor.y_m);
  const Point2 t = rotate(mount_m, sweep.nominal_heading_rad);
  return {t.x(), t.y(), wrap_angle(std::atan2(forward.y(), forward.x()) + sweep.nominal_heading_rad)};
}

}  // namespace shapemap
