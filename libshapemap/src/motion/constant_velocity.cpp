// SPDX-License-Identifier: GPL-3.0-or-later
#include "constant_velocity.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

/// So many scans tell what is usual. The bound is twice the quantile of this share, since scans that are not tracked
/// move more.
constexpr std::size_t kEnough = 50;
constexpr double kMostOfThem = 0.95;
constexpr double kSlack = 2.0;

/// The usual deviation is at least this share of kUsualSurprise, because scans fix a pose, and time stamps are even,
/// only to such a degree.
constexpr double kLeast = 0.125;

}  // namespace

double surprise(const ExpectedPose& expected, const Pose2& found) {
  constexpr double kMost = 4.0;
  const Pose2 off = inverse(expected.pose) * found;
  const double far = std::max(0.0, off.translation().norm() / expected.usual_m - 1.0);
  const double turned = std::max(0.0, std::abs(off.theta_rad) / expected.usual_rad - 1.0);
  return std::min(kMost, 2.0 * far) + std::min(kMost, 2.0 * turned);
}

void ConstantVelocityPrior::learn(const Pose2& off) {
  count(off.translation().norm() / kUsualSurprise_m, by_distance_);
  count(std::abs(off.theta_rad) / kUsualSurprise_rad, by_angle_);
  ++count_;
}

ExpectedPose ConstantVelocityPrior::at(const Pose2& pose) const {
  return {pose, kUsualSurprise_m * usual_share(by_distance_, count_),
          kUsualSurprise_rad * usual_share(by_angle_, count_)};
}

void ConstantVelocityPrior::count(double share_of_most, Histogram& histogram) {
  ++histogram[std::min(kBins - 1, static_cast<std::size_t>(share_of_most * static_cast<double>(kBins)))];
}

double ConstantVelocityPrior::usual_share(const Histogram& histogram, std::size_t count) {
  if (count < kEnough) return 1.0;
  std::size_t within = 0;
  std::size_t bin = 0;
  while (bin < kBins && static_cast<double>(within) < kMostOfThem * static_cast<double>(count)) {
    within += histogram[bin++];
  }
  return std::clamp(kSlack * static_cast<double>(bin) / static_cast<double>(kBins), kLeast, 1.0);
}

}  // namespace shapemap
