// SPDX-License-Identifier: GPL-3.0-or-later
// Scans that follow each other closely along a line, of which the third is off.
#include "map/steady_motion.hpp"

#include <gmock/gmock.h>

#include "support/matchers.hpp"

namespace shapemap {
namespace {

constexpr std::size_t kOff = 2;

struct Line {
  /// Scans `step_m` apart, facing along `heading_rad`; the covariances are as along a corridor.
  explicit Line(double step_m = 0.1, double heading_rad = 0.0) : along(Pose2{1.0, 2.0, heading_rad}) {
    log.positions.resize(5);
    for (std::size_t i = 0; i < 5; ++i) {
      PositionResult outcome;
      outcome.position_index = i;
      outcome.is_keyframe = i == 0;
      outcome.alignment.ref_from_query = {step_m * static_cast<double>(i), 0.0, 0.0};
      outcome.alignment.covariance = Eigen::Vector3d(0.2 * 0.2, 0.01 * 0.01, 0.002 * 0.002).asDiagonal();
      outcomes.push_back(outcome);
      PlacedPosition position;
      position.position_index = i;
      position.map_from_robot = at(step_m * static_cast<double>(i));
      placed.push_back(position);
    }
  }

  Pose2 at(double along_m, double aside_m = 0.0) const { return along * Pose2{along_m, aside_m, 0.0}; }
  void steady() { steady_motion(log, outcomes, placed); }

  Pose2 along;
  Log log;
  std::vector<PositionResult> outcomes;
  std::vector<PlacedPosition> placed;
};

TEST(SteadyMotion, DrawsAScanBackAlongACorridor) {
  for (const double heading_rad : {0.0, 0.8, -2.5}) {
    Line line(0.1, heading_rad);
    line.placed[kOff].map_from_robot = line.at(0.2 + 0.08);
    line.steady();
    const double expected_m = 0.2 + 0.08 * (1.0 - 0.04 / (0.04 + 0.01));
    EXPECT_THAT(line.placed[kOff].map_from_robot, test::IsNearPose(line.at(expected_m), 1e-9, 1e-9)) << heading_rad;
  }
}

TEST(SteadyMotion, LeavesWhatTheScanTells) {
  Line line(0.1, 0.8);
  line.placed[kOff].map_from_robot = line.at(0.2, 0.08);
  line.steady();
  EXPECT_THAT(line.placed[kOff].map_from_robot, test::IsNearPose(line.at(0.2, 0.08), 0.001, 1e-4));
}

TEST(SteadyMotion, LeavesAStraightLineAndItsEnds) {
  Line line(0.1, 0.8);
  const std::vector<PlacedPosition> before = line.placed;
  line.steady();
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_THAT(line.placed[i].map_from_robot, test::IsNearPose(before[i].map_from_robot, 1e-12, 1e-12)) << i;
  }
}

TEST(SteadyMotion, TurnsByTheShorterWay) {
  Line line(0.1, kPi - 0.01);
  for (std::size_t i = 0; i < 5; ++i) {
    line.outcomes[i].alignment.covariance(2, 2) = 1.0;
    line.placed[i].map_from_robot.theta_rad = wrap_angle(kPi - 0.02 + 0.01 * static_cast<double>(i));
  }
  line.placed[kOff].map_from_robot.theta_rad = wrap_angle(kPi + 0.05);
  line.steady();
  EXPECT_NEAR(angle_between(line.placed[kOff].map_from_robot.theta_rad, kPi), 0.0, 0.002);
}

TEST(SteadyMotion, IsForScansThatFollowCloselyOnly) {
  const auto stays = [](Line line) {
    const Pose2 off = line.placed[kOff].map_from_robot = line.at(0.2 + 0.05);
    line.steady();
    return line.placed[kOff].map_from_robot == off;
  };
  EXPECT_FALSE(stays(Line()));
  Line keyframe;
  keyframe.outcomes[kOff].is_keyframe = true;
  EXPECT_TRUE(stays(keyframe));
  Line gap;
  for (std::size_t i = kOff + 1; i < 5; ++i) ++gap.placed[i].position_index;
  gap.log.positions.resize(6);
  gap.outcomes.push_back(gap.outcomes.back());
  EXPECT_TRUE(stays(gap));
  Line another_log;
  another_log.log.starts = {0, kOff};
  EXPECT_TRUE(stays(another_log));
  Line far;
  far.placed[kOff + 1].map_from_robot = far.at(0.7);
  EXPECT_TRUE(stays(far));
  Line unknown;
  unknown.outcomes[kOff].alignment.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(stays(unknown));
}

}  // namespace
}  // namespace shapemap
