// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

/// Every angle in the library is in radians; degrees exist only in option names and files.
namespace shapemap {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;

/// Returns the same direction in [-pi, pi]. An angle that is not finite gives a result that is not finite.
inline double wrap_angle(double angle_rad) { return std::remainder(angle_rad, 2.0 * kPi); }

/// Returns the smallest absolute difference of two directions, in [0, pi].
inline double angle_between(double a_rad, double b_rad) { return std::abs(wrap_angle(a_rad - b_rad)); }

}  // namespace shapemap
