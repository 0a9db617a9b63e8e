// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/beam_angles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shapemap/core/angles.hpp"
#include "shapemap/scan/returns.hpp"

namespace shapemap {
namespace {

using testing::ElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void expect_beams(const StatedAngles& stated, std::size_t num_beams, double step_deg, AngleSource source) {
  const std::optional<EvenBeams> beams = even_beams(stated, num_beams);
  ASSERT_TRUE(beams.has_value());
  EXPECT_EQ(beams->first_rad, stated.first_rad);
  EXPECT_NEAR(beams->step_rad / kDegree, step_deg, 1e-9);
  EXPECT_EQ(beams->source, source);
}

TEST(EvenBeams, AreAsTheStepSaysWhereLimitsAgree) {
  const double first_rad = -135 * kDegree;
  expect_beams({first_rad, 0.25 * kDegree, 135 * kDegree}, 1081, 0.25, AngleSource::kAsStated);
  expect_beams({first_rad, 0.25 * kDegree, std::nullopt}, 1081, 0.25, AngleSource::kAsStated);
  // The header of this full circle counts the first beam twice.
  expect_beams({-kPi, kDegree, kPi}, 360, 1.0, AngleSource::kAsStated);
  expect_beams({kPi, -kDegree, -kPi}, 360, -1.0, AngleSource::kAsStated);
}

TEST(EvenBeams, AreAsTheStepSaysWhereLimitsAreOfAnotherCount) {
  expect_beams({-kPi / 2, 0.5 * kDegree, kPi / 2}, 181, 0.5, AngleSource::kStep);
  expect_beams({0.0, 0.5 * kDegree, kNan}, 181, 0.5, AngleSource::kStep);
}

TEST(EvenBeams, AreAsTheLimitsSayWhereTheStepCannotBe) {
  const double first_rad = -kPi / 2;
  const double last_rad = kPi / 2;
  for (const double step_rad : {0.0, kNan, -kDegree, 1e6, 3 * kDegree, std::numeric_limits<double>::infinity()}) {
    SCOPED_TRACE(step_rad);
    expect_beams({first_rad, step_rad, last_rad}, 181, 1.0, AngleSource::kLimits);
  }
  expect_beams({first_rad, std::nullopt, last_rad}, 181, 1.0, AngleSource::kAsStated);
}

TEST(EvenBeams, AreNoneWhereNothingCanBeRight) {
  EXPECT_FALSE(even_beams({0.0, 0.0, 0.0}, 10));
  EXPECT_FALSE(even_beams({0.0, 1e6, 1e300}, 10));
  EXPECT_FALSE(even_beams({kNan, kDegree, std::nullopt}, 10));
  EXPECT_FALSE(even_beams({0.0, std::nullopt, std::nullopt}, 2));
  EXPECT_TRUE(even_beams({0.0, std::nullopt, std::nullopt}, 1)) << "one beam needs no step";
  EXPECT_TRUE(even_beams({0.0, 0.0, 0.0}, 0));
}

TEST(UnevenBeams, HaveTheTypicalStepAndTheDirectionOfMost) {
  Sweep sweep;
  sweep.ranges_m = {1.0F, 1.0F, 1.0F, 1.0F, 1.0F};
  set_beam_angles(sweep, {0.0, -0.1, -0.2, -0.15, -0.5});
  EXPECT_NEAR(sweep.angle_step_rad, -0.1, 1e-12);
  EXPECT_EQ(sweep.beam_angle_rad(3), -0.15);
  EXPECT_FALSE(sweep.is_evenly_spaced());
}

TEST(UnevenBeams, GiveReturnsFromRightToLeftInAnyOrderOfReadings) {
  Sweep sweep;
  sweep.ranges_m = {3.0F, 1.0F, 4.0F, 2.0F};
  set_beam_angles(sweep, {0.3, 0.1, 0.4, 0.2});
  std::vector<double> ranges_m;
  for (const Return& hit : returns_in_robot(sweep, {})) ranges_m.push_back(hit.range_m);
  EXPECT_THAT(ranges_m, ElementsAre(1.0, 2.0, 3.0, 4.0));
  sweep.robot_from_sensor.roll_rad = kPi;
  ranges_m.clear();
  for (const Return& hit : returns_in_robot(sweep, {})) {
    ranges_m.push_back(hit.range_m);
    EXPECT_LT(hit.p_in_robot_m.y(), 0.0);
  }
  EXPECT_THAT(ranges_m, ElementsAre(4.0, 3.0, 2.0, 1.0));
}

TEST(UnevenBeams, GoToTheNearestOfEvenOnes) {
  Sweep sweep;
  sweep.ranges_m = {1.0F, 2.0F, std::nanf(""), 4.0F, 3.0F};
  set_beam_angles(sweep, {0.0, 0.11, 0.2, 0.3, 0.31});
  const Sweep even = on_even_beams(sweep);
  EXPECT_TRUE(even.is_evenly_spaced());
  ASSERT_EQ(even.ranges_m.size(), 4U);
  EXPECT_EQ(even.ranges_m[0], 1.0F);
  EXPECT_EQ(even.ranges_m[1], 2.0F);
  EXPECT_TRUE(std::isnan(even.ranges_m[2]));
  EXPECT_EQ(even.ranges_m[3], 3.0F) << "the nearer of two";
}

TEST(BeamTimes, GoOnFromTheStartByTheStep) {
  Sweep sweep;
  sweep.start_s = 0.5;
  sweep.beam_time_step_s = 0.01;
  EXPECT_DOUBLE_EQ(sweep.beam_time_s(10), 0.6);
  sweep.beam_times_s = {0.125F, 0.25F};
  EXPECT_EQ(sweep.beam_time_s(1), 0.25);
}

}  // namespace
}  // namespace shapemap
