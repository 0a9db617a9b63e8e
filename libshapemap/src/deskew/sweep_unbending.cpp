// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_unbending.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "shapemap/scan/beam_angles.hpp"

namespace shapemap {
namespace {

struct Beam {
  double angle_rad = 0.0;  ///< in the sensor's own plane and direction of counting
  float range_m = 0.0F;
};

struct Mount {
  Pose2 robot_from_sensor;
  double upward = 1.0;  ///< -1 for a sensor that is mounted upside down
};

/// Returns the beam from the pose of the sensor at the stamp to the point that `beam` hit.
Beam unbent_beam(const Sweep& sweep, std::size_t beam, const RangeLimits& limits, const Mount& mount,
                 const Pose2& stamp_from_beam) {
  const auto& [robot_from_sensor, upward] = mount;
  const float range_m = sweep.ranges_m[beam];
  const double angle_rad = sweep.beam_angle_rad(beam);
  if (!is_return(range_m, limits)) return {angle_rad + upward * stamp_from_beam.theta_rad, range_m};
  const double bearing_rad = upward * angle_rad;
  const Point2 seen_m = static_cast<double>(range_m) * Point2(std::cos(bearing_rad), std::sin(bearing_rad));
  const Point2 straight_m = (inverse(robot_from_sensor) * stamp_from_beam * robot_from_sensor) * seen_m;
  const double turn_rad = wrap_angle(std::atan2(straight_m.y(), straight_m.x()) - bearing_rad);
  return {angle_rad + upward * turn_rad, static_cast<float>(straight_m.norm())};
}

/// Returns the beams that lie within one turn from the first, by angle in the direction in which the sweep goes round.
std::vector<std::size_t> once_round(const std::vector<Beam>& beams, double direction) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double gone_rad = direction * (beams[i].angle_rad - beams.front().angle_rad);
    if (gone_rad < 2.0 * kPi) kept.push_back(i);
  }
  std::stable_sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) {
    return direction * beams[a].angle_rad < direction * beams[b].angle_rad;
  });
  // Beams before the first one may lie where the last ones are.
  const double first_rad = kept.empty() ? 0.0 : direction * beams[kept.front()].angle_rad;
  while (!kept.empty() && direction * beams[kept.back()].angle_rad - first_rad >= 2.0 * kPi) kept.pop_back();
  return kept;
}

}  // namespace

Sweep unbent(const Sweep& sweep, const ReturnOptions& options, const BeamMotion& stamp_from_beam) {
  const RangeLimits limits = range_limits(sweep, options);
  const Mount mount{robot_from_sensor2(sweep), is_upside_down(sweep.robot_from_sensor) ? -1.0 : 1.0};
  const std::size_t num = sweep.ranges_m.size();
  std::vector<Beam> beams;
  beams.reserve(num);
  for (std::size_t i = 0; i < num; ++i) {
    beams.push_back(unbent_beam(sweep, i, limits, mount, stamp_from_beam(i)));
  }
  const double direction = num > 1 && sweep.beam_angle_rad(num - 1) < sweep.beam_angle_rad(0) ? -1.0 : 1.0;
  Sweep straight = sweep;
  straight.ranges_m.clear();
  straight.intensities.clear();
  std::vector<double> angles_rad;
  for (const std::size_t i : once_round(beams, direction)) {
    straight.ranges_m.push_back(beams[i].range_m);
    angles_rad.push_back(beams[i].angle_rad);
    if (!sweep.intensities.empty()) straight.intensities.push_back(sweep.intensities[i]);
  }
  set_beam_angles(straight, std::move(angles_rad));
  straight.angle_step_rad = sweep.angle_step_rad;  // several echoes of a beam are no longer at the same angle
  straight.beam_times_s.clear();
  straight.beam_time_step_s = 0.0;
  straight.start_s = 0.0;
  return straight;
}

double most_bent_m(const Sweep& sweep, const ReturnOptions& options, const BeamMotion& stamp_from_beam) {
  double most_m = 0.0;
  for (const Return& hit : returns_in_robot(sweep, options)) {
    most_m = std::max(most_m, (stamp_from_beam(hit.beam) * hit.p_in_robot_m - hit.p_in_robot_m).norm());
  }
  return most_m;
}

}  // namespace shapemap
