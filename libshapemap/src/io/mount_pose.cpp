// SPDX-License-Identifier: GPL-3.0-or-later
#include "mount_pose.hpp"

#include <algorithm>

namespace shapemap {

MountPose mount_with_heading(const Sweep& sweep) {
  MountPose mount = sweep.robot_from_sensor;
  if (sweep.nominal_heading_rad == 0.0) return mount;
  const Point2 turned = rotate(Point2(mount.x_m, mount.y_m), sweep.nominal_heading_rad);
  mount.x_m = turned.x();
  mount.y_m = turned.y();
  mount.yaw_rad = wrap_angle(mount.yaw_rad + sweep.nominal_heading_rad);
  return mount;
}

Sweep counterclockwise(Sweep sweep) {
  if (sweep.angle_step_rad >= 0.0 || sweep.ranges_m.empty() || !sweep.is_evenly_spaced()) return sweep;
  sweep.first_angle_rad = sweep.beam_angle_rad(sweep.ranges_m.size() - 1);
  sweep.angle_step_rad = -sweep.angle_step_rad;
  std::reverse(sweep.ranges_m.begin(), sweep.ranges_m.end());
  return sweep;
}

}  // namespace shapemap
