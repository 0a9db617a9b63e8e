// SPDX-License-Identifier: GPL-3.0-or-later
#include "deskew/sweep_unbending.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/bent_sweeps.hpp"

namespace shapemap {
namespace {

using test::RollingLaser;

constexpr double kRounding_m = 1e-5;  // ranges are floats

/// Unbends all sweeps by the exact motion.
void unbend(Log& log, const test::Motion& world_from_laser, const RollingLaser& laser) {
  for (Scan& scan : log.scans) {
    const double start_s = scan.timestamp_s;
    for (Sweep& sweep : scan.sweeps) {
      sweep = unbent(sweep, {}, [&](std::size_t beam) {
        return inverse(world_from_laser(start_s)) *
               world_from_laser(start_s + static_cast<double>(beam) * laser.beam_step_s());
      });
    }
  }
}

TEST(Unbent, ByTheExactMotionEveryHitIsOnItsWall) {
  const test::World world = test::cluttered_room(5);
  const test::Motion motion = test::swinging(40 * kDegree, 0.8);
  for (const bool clockwise : {false, true}) {
    RollingLaser laser;
    laser.clockwise = clockwise;
    Log log = test::bent_log(world, motion, 9, laser);
    EXPECT_GT(test::off_the_walls_m(log, world), 0.05);
    unbend(log, motion, laser);
    EXPECT_LT(test::off_the_walls_m(log, world), kRounding_m) << clockwise;
  }
}

TEST(Unbent, AMountedAndUpsideDownLaserSeesTheSame) {
  const test::World world = test::cluttered_room(5);
  const test::Motion robot = test::swinging(40 * kDegree, 0.8);
  const Pose2 robot_from_sensor{0.3, -0.2, 1.1};
  const RollingLaser laser;
  Log log = test::bent_log(
      world, [&](double time_s) { return robot(time_s) * robot_from_sensor; }, 6, laser);
  for (Scan& scan : log.scans) {
    Sweep& sweep = scan.sweeps[0];
    // A sweep that runs counterclockwise seen from above runs clockwise for a laser that hangs from the ceiling.
    sweep.first_angle_rad = -sweep.first_angle_rad;
    sweep.angle_step_rad = -sweep.angle_step_rad;
    sweep.robot_from_sensor = {0.3, -0.2, 0.0, 1.1, 0.0, kPi};
    scan.reference_pose = robot(scan.timestamp_s);
  }
  EXPECT_GT(test::off_the_walls_m(log, world), 0.05);
  unbend(log, robot, laser);
  EXPECT_LT(test::off_the_walls_m(log, world), kRounding_m);
}

TEST(Unbent, WhatGoesRoundMoreThanOnceIsSeenOnce) {
  const test::World world = test::uneven_room();
  RollingLaser laser;
  const double turn_rad = 50 * kDegree;
  const auto turning = [&](double sign) {
    return [=](double time_s) { return Pose2{0.0, 0.0, sign * turn_rad * time_s / 0.1}; };
  };
  Log more = test::bent_log(world, turning(1.0), 1, laser);
  unbend(more, turning(1.0), laser);
  const Sweep& sweep = more.scans[0].sweeps[0];
  const double expected = laser.num_beams * 360.0 / 410.0;
  EXPECT_NEAR(static_cast<double>(sweep.ranges_m.size()), expected, 2.0);
  EXPECT_LE(sweep.beam_angles_rad.back() - sweep.beam_angles_rad.front(), 2 * kPi);
  Log less = test::bent_log(world, turning(-1.0), 1, laser);
  unbend(less, turning(-1.0), laser);
  EXPECT_EQ(less.scans[0].sweeps[0].ranges_m.size(), static_cast<std::size_t>(laser.num_beams));
}

TEST(Unbent, BeamsAreSortedAndThoseWithoutReturnTurned) {
  Sweep sweep;
  sweep.first_angle_rad = -0.2;
  sweep.angle_step_rad = 0.1;
  sweep.max_range_m = 10.0;
  sweep.ranges_m = {0.5F, std::numeric_limits<float>::quiet_NaN(), 10.0F, 3.0F};
  sweep.intensities = {1.0F, 2.0F, 3.0F, 4.0F};
  // The first beam is sent a metre to the side, so that near points are seen in quite another direction.
  const Sweep straight = unbent(sweep, {}, [](std::size_t beam) {
    return beam == 0 ? Pose2{0.0, 1.0, 0.0} : Pose2{0.0, 0.0, 0.01 * static_cast<double>(beam)};
  });
  ASSERT_EQ(straight.ranges_m.size(), 4U);
  EXPECT_TRUE(std::is_sorted(straight.beam_angles_rad.begin(), straight.beam_angles_rad.end()));
  EXPECT_EQ(straight.intensities, (std::vector<float>{2.0F, 3.0F, 4.0F, 1.0F}));
  EXPECT_TRUE(std::isnan(straight.ranges_m[0]));
  EXPECT_NEAR(straight.beam_angles_rad[0], -0.1 + 0.01, 1e-12);
  EXPECT_FLOAT_EQ(straight.ranges_m[1], 10.0F);
  EXPECT_NEAR(straight.beam_angles_rad[1], 0.02, 1e-12);
  EXPECT_NEAR(straight.ranges_m[3], std::hypot(0.5 * std::cos(0.2), 1.0 - 0.5 * std::sin(0.2)), 1e-6);
}

TEST(MostBent, IsHowFarAHitMoves) {
  Sweep sweep;
  sweep.angle_step_rad = 0.1;
  sweep.max_range_m = 10.0;
  sweep.ranges_m = {2.0F, 4.0F, 10.0F};
  const auto turned = [](std::size_t beam) { return Pose2{0.0, 0.0, 0.01 * static_cast<double>(beam)}; };
  EXPECT_NEAR(most_bent_m(sweep, {}, turned), 0.04, 1e-5);
  EXPECT_EQ(most_bent_m(sweep, {}, [](std::size_t) { return Pose2{}; }), 0.0);
}

}  // namespace
}  // namespace shapemap
