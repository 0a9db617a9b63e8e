// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory_smoothing.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace shapemap {
namespace {

/// Scans that follow each other closely are at most this far apart.
constexpr double kLongestStep_m = 0.20;
constexpr double kLargestTurn_rad = 10 * kDegree;

/// A scan usually deviates so much from the middle between the one before and the one after.
constexpr double kUsualOff_m = 0.10;
constexpr double kUsualOff_rad = 5 * kDegree;

bool follows_closely(const TrackedPose& before, const TrackedPose& after) {
  return after.scan_index == before.scan_index + 1 && after.session == before.session &&
         is_within(inverse(before.map_from_robot) * after.map_from_robot, {kLongestStep_m, kLargestTurn_rad});
}

Pose2 drawn_to_middle(const Pose2& before, const Pose2& pose, const Pose2& after, const Eigen::Matrix3d& covariance) {
  const double to_before_rad = wrap_angle(before.theta_rad - pose.theta_rad);
  const double to_after_rad = wrap_angle(after.theta_rad - pose.theta_rad);
  Eigen::Vector3d to_middle;
  to_middle.head<2>() = 0.5 * (before.translation() + after.translation()) - pose.translation();
  to_middle[2] = 0.5 * (to_before_rad + to_after_rad);
  const Eigen::Matrix3d usual = Eigen::Vector3d(kUsualOff_m, kUsualOff_m, kUsualOff_rad).cwiseAbs2().asDiagonal();
  const Eigen::Vector3d shift = covariance * (covariance + usual).inverse() * to_middle;
  return {pose.x_m + shift[0], pose.y_m + shift[1], wrap_angle(pose.theta_rad + shift[2])};
}

}  // namespace

void smooth_trajectory(std::vector<TrackedPose>& poses) {
  std::vector<Pose2> measured;
  for (const TrackedPose& pose : poses) measured.push_back(pose.map_from_robot);
  std::vector<bool> follows(poses.size(), false);
  for (std::size_t i = 1; i < poses.size(); ++i) follows[i] = follows_closely(poses[i - 1], poses[i]);
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const std::optional<Eigen::Matrix3d>& covariance = poses[i].covariance;
    if (!covariance || !covariance->allFinite() || !follows[i] || !follows[i + 1]) continue;
    poses[i].map_from_robot = drawn_to_middle(measured[i - 1], measured[i], measured[i + 1], *covariance);
  }
}

}  // namespace shapemap
