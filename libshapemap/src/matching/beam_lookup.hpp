// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "shapemap/core/pose2.hpp"
#include "shapemap/shape/range_image.hpp"

/// These functions find the beams towards many points quickly, and the same beams as RangeImage::beam_at().
namespace shapemap {

/// The largest error of `approximate_bearing_rad`.
inline constexpr double kBearingError_rad = 2e-8;

/// Approximates std::atan2 without branches, so that a loop over many points is vectorised. It gives NaN for (0, 0).
inline double approximate_bearing_rad(double x, double y) {
  const double along = std::abs(x);
  const double across = std::abs(y);
  const double longer = along > across ? along : across;
  const double shorter = along > across ? across : along;
  const double t = shorter / longer;
  const double u = t * t;
  const double u2 = u * u;
  const double u4 = u2 * u2;
  // The polynomial interpolates atan(t) / t on [0, 1] at Chebyshev nodes; its error is at most 1e-8.
  const double low = (0.999999981789 - 0.333330367093 * u) + (0.199918720289 - 0.141977977926 * u) * u2;
  const double high = (0.106183706313 - 0.0745685481416 * u) + (0.0421376234502 - 0.0157312490368 * u) * u2;
  const double first_octant = t * (low + (high + 0.0027662834804 * u4) * u4);
  const double first_quadrant = along > across ? first_octant : 0.5 * kPi - first_octant;
  return std::copysign(x < 0.0 ? kPi - first_quadrant : first_quadrant, y);
}

/// Returns RangeImage::beam_at() of the bearing of a point in the sensor's frame, given its approximate bearing
/// `near_rad`. The exact bearing is computed only where the border of two beams is too near to be sure.
inline int beam_near(const RangeImage& image, double near_rad, const Point2& in_sensor_m) {
  constexpr double kRounding = 1e-9;
  const double per_rad = 1.0 / image.step_rad;
  const double beams_in_turn = 2.0 * kPi * per_rad;
  const double error = kBearingError_rad * per_rad + kRounding;
  double beam = (near_rad - image.first_bearing_rad) * per_rad + 0.5;
  if (beam < -error) beam += beams_in_turn;
  const auto index = static_cast<int>(beam > 0.0 && beam < beams_in_turn ? beam : -1.0);
  const double past_border = beam - index;
  // The comparisons are false for NaN, which is therefore never certain.
  const bool is_certain =
      index >= 0 && past_border > error && past_border < 1.0 - error && beam < beams_in_turn - error;
  if (!is_certain) return image.beam_at(std::atan2(in_sensor_m.y(), in_sensor_m.x()));
  const auto count = static_cast<int>(image.beams.size());
  if (index < count) return index;
  return beams_in_turn - count < 1e-6 ? count - 1 : -1;
}

}  // namespace shapemap
