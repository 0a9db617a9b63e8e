// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/returns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace shapemap {
namespace {

constexpr double kTiny = 1e-12;

Sweep three_beams(double first_angle_rad, double angle_step_rad) {
  Sweep sweep;
  sweep.first_angle_rad = first_angle_rad;
  sweep.angle_step_rad = angle_step_rad;
  sweep.ranges_m = {1.0F, 2.0F, 3.0F};
  return sweep;
}

void expect_point(const Return& hit, double x_m, double y_m, std::size_t beam) {
  EXPECT_NEAR(hit.p_in_robot_m.x(), x_m, kTiny);
  EXPECT_NEAR(hit.p_in_robot_m.y(), y_m, kTiny);
  EXPECT_EQ(hit.beam, beam);
}

TEST(Returns, LieWhereTheBeamsPoint) {
  const std::vector<Return> hits = returns_in_robot(three_beams(-kPi / 2, kPi / 2), {});
  ASSERT_EQ(hits.size(), 3U);
  expect_point(hits[0], 0.0, -1.0, 0);
  expect_point(hits[1], 2.0, 0.0, 1);
  expect_point(hits[2], 0.0, 3.0, 2);
  EXPECT_EQ(hits[2].range_m, 3.0);
}

TEST(Returns, OfAClockwiseSensorAreOrderedCounterclockwise) {
  const std::vector<Return> hits = returns_in_robot(three_beams(kPi / 2, -kPi / 2), {});
  ASSERT_EQ(hits.size(), 3U);
  expect_point(hits[0], 0.0, -3.0, 2);
  expect_point(hits[1], 2.0, 0.0, 1);
  expect_point(hits[2], 0.0, 1.0, 0);
}

TEST(Returns, OfAnUpsideDownSensorAreMirroredAndOrderedCounterclockwise) {
  Sweep sweep = three_beams(-kPi / 2, kPi / 2);
  sweep.robot_from_sensor.roll_rad = kPi;
  const std::vector<Return> hits = returns_in_robot(sweep, {});
  ASSERT_EQ(hits.size(), 3U);
  expect_point(hits[0], 0.0, -3.0, 2);
  expect_point(hits[2], 0.0, 1.0, 0);
}

TEST(Returns, UpsideDownAndClockwiseCancelInOrder) {
  Sweep sweep = three_beams(kPi / 2, -kPi / 2);
  sweep.robot_from_sensor.roll_rad = kPi;
  const std::vector<Return> hits = returns_in_robot(sweep, {});
  ASSERT_EQ(hits.size(), 3U);
  expect_point(hits[0], 0.0, -1.0, 0);
  expect_point(hits[2], 0.0, 3.0, 2);
}

TEST(Returns, MountAndHeadingMoveThem) {
  Sweep sweep = three_beams(0.0, 0.1);
  sweep.ranges_m.resize(1);
  sweep.robot_from_sensor = {0.5, 0.25, 1.0, kPi / 2, 0.0, 0.0};
  expect_point(returns_in_robot(sweep, {}).at(0), 0.5, 1.25, 0);
  sweep.nominal_heading_rad = kPi / 2;
  expect_point(returns_in_robot(sweep, {}).at(0), -1.25, 0.5, 0);
  const Pose2 pose = robot_from_sensor2(sweep);
  EXPECT_NEAR(pose.x_m, -0.25, kTiny);
  EXPECT_NEAR(pose.y_m, 0.5, kTiny);
  EXPECT_NEAR(angle_between(pose.theta_rad, kPi), 0.0, kTiny);
}

TEST(Returns, OfATiltedSensorAreProjectedToTheFloor) {
  Sweep sweep = three_beams(0.0, kPi / 2);
  sweep.ranges_m.resize(2);
  sweep.robot_from_sensor.pitch_rad = 20 * kDegree;
  const std::vector<Return> hits = returns_in_robot(sweep, {});
  ASSERT_EQ(hits.size(), 2U);
  expect_point(hits[0], std::cos(20 * kDegree), 0.0, 0);
  expect_point(hits[1], 0.0, 2.0, 1);  // sideways, along the axis of the tilt
}

TEST(Returns, ASteepSensorHasNone) {
  Sweep sweep = three_beams(0.0, 0.1);
  sweep.robot_from_sensor.pitch_rad = 31 * kDegree;
  EXPECT_TRUE(returns_in_robot(sweep, {}).empty());
  ReturnOptions options;
  options.max_mount_tilt_rad = 32 * kDegree;
  EXPECT_EQ(returns_in_robot(sweep, options).size(), 3U);
  sweep.robot_from_sensor.pitch_rad = 0.0;
  sweep.robot_from_sensor.roll_rad = kPi - 31 * kDegree;
  EXPECT_TRUE(returns_in_robot(sweep, {}).empty());
}

TEST(Returns, LimitsOfTheLogAreOverriddenByOptions) {
  Sweep sweep = three_beams(0.0, 0.1);
  sweep.min_range_m = 1.5;
  sweep.max_range_m = 3.0;
  ASSERT_EQ(returns_in_robot(sweep, {}).size(), 1U);
  EXPECT_EQ(returns_in_robot(sweep, {})[0].beam, 1U);
  ReturnOptions options;
  options.min_range_m = 0.5;
  options.max_range_m = 2.5;
  EXPECT_EQ(returns_in_robot(sweep, options).size(), 2U);
  options.max_range_m = 10.0;
  EXPECT_EQ(returns_in_robot(sweep, options).size(), 3U);
}

TEST(Returns, WhatIsNoDistanceIsNoReturn) {
  const RangeLimits no_limits = range_limits(Sweep{}, {});
  EXPECT_TRUE(is_return(999.0F, no_limits));
  EXPECT_FALSE(is_return(1000.0F, no_limits));  // no 2D laser measures a kilometre
  EXPECT_FALSE(is_return(1e6F, range_limits(Sweep{}, {0.0, 1e9})));
  for (const float range_m : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(),
                              std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
    EXPECT_FALSE(is_return(range_m, no_limits)) << range_m;
  }
}

TEST(Returns, AReadingAtALimitThatNoFloatHoldsExactly) {
  EXPECT_FALSE(is_return(5.6F, {0.0, 5.6}));  // 5.6F < 5.6
  EXPECT_TRUE(is_return(0.7F, {0.7, 10.0}));  // 0.7F < 0.7
  EXPECT_FALSE(is_return(8.1F, {0.0, 8.1}));
}

}  // namespace
}  // namespace shapemap
