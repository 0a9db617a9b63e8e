// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// Where scans follow each other closely, the next one is usually so near to where it was to be expected, at worst.
inline constexpr double kUsualSurprise_m = 0.4;
inline constexpr double kUsualSurprise_rad = 25 * kDegree;

/// Where the motion so far would take the sensor.
struct ExpectedPose {
  Pose2 pose;                         ///< in the frame of the keyframe before
  double usual_m = kUsualSurprise_m;  ///< it is usually found so near
  double usual_rad = kUsualSurprise_rad;
};

/// As logarithm of odds against it, of a scan that is found so far from where it was to be expected.
double surprise(const ExpectedPose& expected, const Pose2& found);

/// Learns from the scans that were followed how near the next one usually is.
class ConstantVelocityPrior {
 public:
  /// A scan was found so far off.
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
