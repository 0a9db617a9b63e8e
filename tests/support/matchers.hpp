// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "shapemap/core/pose2.hpp"

namespace shapemap::test {

MATCHER_P2(IsNearPoint, expected, tolerance_m, "") {
  const double off_m = (arg - expected).norm();
  *result_listener << "(" << arg.x() << ", " << arg.y() << ") is " << off_m << " m off";
  return off_m <= tolerance_m;
}

MATCHER_P3(IsNearPose, expected, tolerance_m, tolerance_rad, "") {
  const double off_m = (arg.translation() - expected.translation()).norm();
  const double off_rad = angle_between(arg.theta_rad, expected.theta_rad);
  *result_listener << "(" << arg.x_m << ", " << arg.y_m << ", " << arg.theta_rad / kDegree << " deg) is " << off_m
                   << " m and " << off_rad / kDegree << " deg off";
  return off_m <= tolerance_m && off_rad <= tolerance_rad;
}

/// Matches the same direction, whatever the number of full turns.
MATCHER_P2(IsNearAngle, expected_rad, tolerance_rad, "") {
  const double off_rad = angle_between(arg, expected_rad);
  *result_listener << arg / kDegree << " deg is " << off_rad / kDegree << " deg off";
  return off_rad <= tolerance_rad;
}

MATCHER(IsNanPose, "") { return std::isnan(arg.x_m) && std::isnan(arg.y_m) && std::isnan(arg.theta_rad); }

/// Matches equal bits; unlike ==, also for NaN.
MATCHER_P(HasSameBits, expected, "") {
  return std::memcmp(&arg.x_m, &expected.x_m, sizeof(double)) == 0 &&
         std::memcmp(&arg.y_m, &expected.y_m, sizeof(double)) == 0 &&
         std::memcmp(&arg.theta_rad, &expected.theta_rad, sizeof(double)) == 0;
}

}  // namespace shapemap::test
