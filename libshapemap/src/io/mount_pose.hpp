// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// Returns the mount at the scan's first heading: the sweep's nominal turn becomes part of it.
MountPose mount_with_heading(const Sweep& sweep);

inline bool operator==(const MountPose& a, const MountPose& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.z_m == b.z_m && a.yaw_rad == b.yaw_rad && a.pitch_rad == b.pitch_rad &&
         a.roll_rad == b.roll_rad;
}

/// Returns the same readings from right to left, for formats without a scan direction.
Sweep counterclockwise(Sweep sweep);

}  // namespace shapemap
