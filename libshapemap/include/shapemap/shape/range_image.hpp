// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/scan.hpp"
#include "shapemap/shape/shape.hpp"

namespace shapemap {

/// A range image holds what one sweep saw by bearing: the surface that ended each beam, and so the space that was free.
/// Points are in the robot's frame, bearings in the sensor's, counterclockwise as seen from above.
struct RangeImage {
  struct Beam {
    double range_m = 0.0;  ///< 0 is no return
    Point2 hit_m{0.0, 0.0};
    Point2 normal{0.0, 0.0};   ///< normal of the surface at the return, towards the sensor
    double footprint_m = 0.0;  ///< half of the length of surface between this beam and the next
  };

  Pose2 sensor_from_robot;
  double first_bearing_rad = 0.0;
  double step_rad = 0.0;  ///< always positive
  std::vector<Beam> beams;

  /// Returns the index of the beam nearest to a bearing, or -1 outside the field of view.
  int beam_at(double bearing_rad) const;
};

/// Makes the image of a sweep whose points and polylines are `shape`. Uneven beams are put on even bearings, one
/// typical step apart.
RangeImage range_image(const Sweep& sweep, const SweepShape& shape);

}  // namespace shapemap
