// SPDX-License-Identifier: GPL-3.0-or-later
// The scans follow each other closely along a line, and the third is off.
#include "motion/trajectory_smoothing.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <limits>

#include "support/matchers.hpp"

namespace shapemap {
namespace {

constexpr std::size_t kOff = 2;

struct Line {
  /// The scans are `step_m` apart and face along `heading_rad`; the covariances are as along a corridor.
  explicit Line(double step_m = 0.1, double heading_rad = 0.0) : along(Pose2{1.0, 2.0, heading_rad}) {
    Eigen::Matrix3d map_from_line = Eigen::Matrix3d::Identity();
    map_from_line.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(heading_rad).toRotationMatrix();
    const Eigen::Matrix3d covariance = Eigen::Vector3d(0.2 * 0.2, 0.01 * 0.01, 0.002 * 0.002).asDiagonal();
    for (std::size_t i = 0; i < 5; ++i) {
      TrackedPose pose{i, 0, at(step_m * static_cast<double>(i)), {}};
      if (i > 0) pose.covariance = map_from_line * covariance * map_from_line.transpose();
      placed.push_back(pose);
    }
  }

  Pose2 at(double along_m, double aside_m = 0.0) const { return along * Pose2{along_m, aside_m, 0.0}; }
  void steady() { smooth_trajectory(placed); }

  Pose2 along;
  std::vector<TrackedPose> placed;
};

TEST(TrajectorySmoothing, DrawsAScanBackAlongACorridor) {
  for (const double heading_rad : {0.0, 0.8, -2.5}) {
    Line line(0.1, heading_rad);
    line.placed[kOff].map_from_robot = line.at(0.2 + 0.08);
    line.steady();
    const double expected_m = 0.2 + 0.08 * (1.0 - 0.04 / (0.04 + 0.01));
    EXPECT_THAT(line.placed[kOff].map_from_robot, test::IsNearPose(line.at(expected_m), 1e-9, 1e-9)) << heading_rad;
  }
}

TEST(TrajectorySmoothing, LeavesWhatTheScanTells) {
  Line line(0.1, 0.8);
  line.placed[kOff].map_from_robot = line.at(0.2, 0.08);
  line.steady();
  EXPECT_THAT(line.placed[kOff].map_from_robot, test::IsNearPose(line.at(0.2, 0.08), 0.001, 1e-4));
}

TEST(TrajectorySmoothing, LeavesAStraightLineAndItsEnds) {
  Line line(0.1, 0.8);
  const std::vector<TrackedPose> before = line.placed;
  line.steady();
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_THAT(line.placed[i].map_from_robot, test::IsNearPose(before[i].map_from_robot, 1e-12, 1e-12)) << i;
  }
}

TEST(TrajectorySmoothing, TurnsByTheShorterWay) {
  Line line(0.1, kPi - 0.01);
  for (std::size_t i = 0; i < 5; ++i) {
    if (i > 0) (*line.placed[i].covariance)(2, 2) = 1.0;
    line.placed[i].map_from_robot.theta_rad = wrap_angle(kPi - 0.02 + 0.01 * static_cast<double>(i));
  }
  line.placed[kOff].map_from_robot.theta_rad = wrap_angle(kPi + 0.05);
  line.steady();
  EXPECT_NEAR(angle_between(line.placed[kOff].map_from_robot.theta_rad, kPi), 0.0, 0.002);
}

TEST(TrajectorySmoothing, IsForScansThatFollowCloselyOnly) {
  const auto stays = [](Line line) {
    const Pose2 off = line.placed[kOff].map_from_robot = line.at(0.2 + 0.05);
    line.steady();
    return line.placed[kOff].map_from_robot == off;
  };
  EXPECT_FALSE(stays(Line()));
  Line keyframe;
  keyframe.placed[kOff].covariance.reset();
  EXPECT_TRUE(stays(keyframe));
  Line gap;
  for (std::size_t i = kOff + 1; i < 5; ++i) ++gap.placed[i].scan_index;
  EXPECT_TRUE(stays(gap));
  Line another_log;
  for (std::size_t i = kOff; i < 5; ++i) another_log.placed[i].session = 1;
  EXPECT_TRUE(stays(another_log));
  Line far;
  far.placed[kOff + 1].map_from_robot = far.at(0.7);
  EXPECT_TRUE(stays(far));
  Line unknown;
  unknown.placed[kOff].covariance->setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(stays(unknown));
}

}  // namespace
}  // namespace shapemap
