// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// Where scans follow each other closely, the next one is usually at most this far from its expected pose.
inline constexpr double kUsualSurprise_m = 0.4;
inline constexpr double kUsualSurprise_rad = 25 * kDegree;

/// The pose to which constant velocity would take the sensor.
struct ExpectedPose {
  Pose2 pose;                         ///< in the frame of the last keyframe
  double usual_m = kUsualSurprise_m;  ///< usual bound of the deviation from `pose`
  double usual_rad = kUsualSurprise_rad;
};

/// Returns the logarithm of the odds against a scan that is found at `found` rather than at its expected pose.
double surprise(const ExpectedPose& expected, const Pose2& found);

/// Learns from tracked scans how near the next one usually is to its expected pose.
class ConstantVelocityPrior {
 public:
  /// Records the deviation of a tracked scan from its expected pose.
  void learn(const Pose2& off);

  ExpectedPose at(const Pose2& pose) const;

 private:
  static constexpr std::size_t kBins = 64;
  using Histogram = std::array<std::size_t, kBins>;
  static void count(double share_of_most, Histogram& histogram);
  static double usual_share(const Histogram& histogram, std::size_t count);

  Histogram by_distance_{};
  Histogram by_angle_{};
  std::size_t count_ = 0;
};

}  // namespace shapemap
