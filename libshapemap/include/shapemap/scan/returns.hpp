// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/scan.hpp"

/// This header turns ranges into points.
namespace shapemap {

struct ReturnOptions {
  double min_range_m = 0.0;  ///< 0 takes the limit of the log
  double max_range_m = 0.0;  ///< 0 takes the limit of the log
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

/// A return is the point where a beam hit a surface.
struct Return {
  Point2 p_in_robot_m;
  std::size_t beam = 0;  ///< index into Sweep::ranges_m
  double range_m = 0.0;
};

/// No 2D laser measures this far: such readings are damaged, and no returns whatever the limits say.
inline constexpr double kLongestRange_m = 1000.0;

/// The range limits that hold for a sweep: those of the options where given, else those of the log, else
/// kLongestRange_m.
struct RangeLimits {
  double min_m = 0.0;
  double max_m = 0.0;
};
RangeLimits range_limits(const Sweep& sweep, const ReturnOptions& options);

/// Says whether a reading is a return: finite, positive and inside the limits. A reading at the maximum is no return.
bool is_return(float range_m, const RangeLimits& limits);

/// Returns the points of one sweep in the robot's frame (x is forward at the nominal heading 0 of the scan), projected
/// to the floor plane and ordered counterclockwise as seen from above, also for clockwise or upside-down sensors. The
/// result is empty for a sensor that is tilted more than `options.max_mount_tilt_rad`.
std::vector<Return> returns_in_robot(const Sweep& sweep, const ReturnOptions& options);

/// Says whether a reading proves that the beam hit nothing: NaN, infinite, or at or beyond a known maximum range. Zero
/// and readings below the minimum range may as well be surfaces too near to measure.
bool is_open(float range_m, const RangeLimits& limits);

/// Returns the end points, in the robot's frame, of beams that hit nothing, followed for `length_m` or up to a known
/// shorter maximum range. The result is empty for a sensor that is tilted more than `options.max_mount_tilt_rad`.
std::vector<Point2> open_ends_in_robot(const Sweep& sweep, const ReturnOptions& options, double length_m);

/// Says whether the sensor's z axis points to the floor, so that its counterclockwise is clockwise from above.
bool is_upside_down(const MountPose& robot_from_sensor);

/// Returns the planar pose of the sensor in the robot's frame, with the sweep's nominal heading applied.
Pose2 robot_from_sensor2(const Sweep& sweep);

}  // namespace shapemap
