// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/scan.hpp"

/// From ranges to points.
namespace shapemap {

struct ReturnOptions {
  double min_range_m = 0.0;  ///< 0: what the log says
  double max_range_m = 0.0;  ///< 0: what the log says
  double max_mount_tilt_rad = 30 * kDegree;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"min-range", "shorter readings are no returns [m]; 0: as the log says", 0, 1000}, self.min_range_m);
    visit(Field{"max-range", "readings from here on are no returns [m]; 0: as the log says", 0, 1000},
          self.max_range_m);
    visit(Field{"max-mount-tilt-deg", "lasers mounted steeper than this see no floor plan [deg]", 0, 89, kDegree},
          self.max_mount_tilt_rad);
  }
};

/// What a beam hit.
struct Return {
  Point2 p_in_robot_m;
  std::size_t beam = 0;  ///< index into Sweep::ranges_m
  double range_m = 0.0;
};

/// No 2D laser measures this far: such readings are damage, and no returns whatever the limits say.
inline constexpr double kLongestRange_m = 1000.0;

/// The limits that hold for `sweep`: the options' where given, else the log's, else kLongestRange_m.
struct RangeLimits {
  double min_m = 0.0;
  double max_m = 0.0;
};
RangeLimits range_limits(const Sweep& sweep, const ReturnOptions& options);

/// Whether a reading is a hit: finite, positive and inside the limits. A reading at the maximum is no hit.
bool is_return(float range_m, const RangeLimits& limits);

/// The hits of one sub-scan in the robot's frame (x forward at the position's nominal heading 0), projected to the
/// floor plane and ordered counterclockwise as seen from above, also for clockwise or upside-down sensors.
/// Empty for a sensor that is tilted more than `options.max_mount_tilt_rad`.
std::vector<Return> returns_in_robot(const Sweep& sweep, const ReturnOptions& options);

/// Whether a reading says that the beam hit nothing: NaN, infinite, or at or beyond a maximum range that is known. Zero
/// and what is below the minimum range may as well be something too near to measure.
bool is_open(float range_m, const RangeLimits& limits);

/// Where beams that hit nothing end in the robot's frame, when they are followed for `length_m`, or up to the maximum
/// range where that is known and shorter. Empty for a sensor that is tilted more than `options.max_mount_tilt_rad`.
std::vector<Point2> open_ends_in_robot(const Sweep& sweep, const ReturnOptions& options, double length_m);

/// Whether the sensor's own z axis points to the floor, so that its counterclockwise is clockwise from above.
bool is_upside_down(const MountPose& robot_from_sensor);

/// Where the sensor stands in the robot's frame, with the sub-scan's nominal heading applied.
Pose2 robot_from_sensor2(const Sweep& sweep);

}  // namespace shapemap
