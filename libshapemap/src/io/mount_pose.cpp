// SPDX-License-Identifier: GPL-3.0-or-later
#include "mount_pose.hpp"

#include <algorithm>

namespace shapemap {

MountPose mount_with_heading(const Sweep& scan) {
  MountPose mount = scan.robot_from_sensor;
  if (scan.nominal_heading_rad == 0.0) return mount;
  const Point2 turned = rotate(Point2(mount.x_m, mount.y_m), scan.nominal_heading_rad);
  mount.x_m = turned.x();
  mount.y_m = turned.y();
  mount.yaw_rad = wrap_angle(mount.yaw_rad + scan.nominal_heading_rad);
  return mount;
}

Sweep counterclockwise(Sweep scan) {
  if (scan.angle_step_rad >= 0.0 || scan.ranges_m.empty() || !scan.is_evenly_spaced()) return scan;
  scan.first_angle_rad = scan.beam_angle_rad(scan.ranges_m.size() - 1);
  scan.angle_step_rad = -scan.angle_step_rad;
  std::reverse(scan.ranges_m.begin(), scan.ranges_m.end());
  return scan;
}

}  // namespace shapemap
