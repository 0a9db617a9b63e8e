// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "slam_method.hpp"
#include "support/synthetic_world.hpp"
#include "support/views.hpp"

/// A robot that walks in small steps through a room whose walls are known.
namespace shapemap::baselines::test {

/// On a circle about the middle of the room, looking ahead.
inline std::vector<Pose2> walk(std::size_t count, double step_m = 0.12) {
  constexpr double kRadius_m = 0.9;
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle_rad = static_cast<double>(i) * step_m / kRadius_m;
    poses.push_back(
        {kRadius_m * std::cos(angle_rad), kRadius_m * std::sin(angle_rad), wrap_angle(angle_rad + kPi / 2)});
  }
  return poses;
}

inline std::vector<Scan> scans_of(const std::vector<Pose2>& poses, unsigned seed = 4) {
  const shapemap::test::World world = shapemap::test::cluttered_room(seed);
  std::mt19937 rng(seed);
  std::vector<Scan> scans;
  for (const Pose2& pose : poses) {
    scans.push_back(shapemap::test::scan_of(world, pose, shapemap::test::full_circle(), rng));
    scans.back().timestamp_s = 1e9 + static_cast<double>(scans.size());
  }
  return scans;
}

inline Eigen::Matrix3d covariance(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
}

/// Zero odometry.
inline Motion nothing_known() { return {Pose2{}, covariance(0.2, 10 * kDegree)}; }

/// Worst distance between consecutive poses' motions.
struct WorstMotion {
  double off_m = 0.0;
  double off_rad = 0.0;
};

inline WorstMotion worst_motion(const std::vector<Pose2>& truth, const std::vector<Pose2>& found) {
  WorstMotion worst;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Pose2 wanted = inverse(truth[i - 1]) * truth[i];
    const Pose2 got = inverse(found.at(i - 1)) * found.at(i);
    worst.off_m = std::max(worst.off_m, (wanted.translation() - got.translation()).norm());
    worst.off_rad = std::max(worst.off_rad, angle_between(wanted.theta_rad, got.theta_rad));
  }
  return worst;
}

}  // namespace shapemap::baselines::test
