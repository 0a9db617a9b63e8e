// SPDX-License-Identifier: GPL-3.0-or-later
#include "steady_motion.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "shapemap/scan/joined_logs.hpp"

namespace shapemap {
namespace {

/// From scan to scan, where they follow each other closely.
constexpr double kLongestStep_m = 0.20;
constexpr double kLargestTurn_rad = 10 * kDegree;

/// A scan is usually so near the middle between the one before and the one after.
constexpr double kUsualOff_m = 0.10;
constexpr double kUsualOff_rad = 5 * kDegree;

bool follows_closely(const Log& log, const PlacedPosition& before, const PlacedPosition& after) {
  return after.position_index == before.position_index + 1 &&
         part_with(log, after.position_index) == part_with(log, before.position_index) &&
         is_within(inverse(before.map_from_robot) * after.map_from_robot, kLongestStep_m, kLargestTurn_rad);
}

/// Of a pose in the frame of the map.
Eigen::Matrix3d covariance_in_map(const Alignment& alignment, const Pose2& map_from_robot) {
  Eigen::Matrix3d map_from_reference = Eigen::Matrix3d::Identity();
  const double heading_rad = map_from_robot.theta_rad - alignment.ref_from_query.theta_rad;
  map_from_reference.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(heading_rad).toRotationMatrix();
  return map_from_reference * alignment.covariance * map_from_reference.transpose();
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

void steady_motion(const Log& log, const std::vector<PositionResult>& outcomes, std::vector<PlacedPosition>& placed) {
  std::vector<Pose2> measured;
  for (const PlacedPosition& position : placed) measured.push_back(position.map_from_robot);
  std::vector<bool> follows(placed.size(), false);
  for (std::size_t i = 1; i < placed.size(); ++i) follows[i] = follows_closely(log, placed[i - 1], placed[i]);
  for (std::size_t i = 1; i + 1 < placed.size(); ++i) {
    const PositionResult& outcome = outcomes[placed[i].position_index];
    if (outcome.is_keyframe || !follows[i] || !follows[i + 1]) continue;
    const Eigen::Matrix3d covariance = covariance_in_map(outcome.alignment, measured[i]);
    if (!covariance.allFinite()) continue;
    placed[i].map_from_robot = drawn_to_middle(measured[i - 1], measured[i], measured[i + 1], covariance);
  }
}

}  // namespace shapemap
