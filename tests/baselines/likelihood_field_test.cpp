// SPDX-License-Identifier: GPL-3.0-or-later
#include "likelihood_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hill_climbing.hpp"
#include "support/matchers.hpp"

namespace shapemap::baselines {
namespace {

TEST(LikelihoodField, IsAGaussianAboutASpot) {
  const double sigma_m = 0.2;
  const Point2 spot_m(3.03, -7.01);
  const LikelihoodField field({{spot_m, 0.8}}, sigma_m);
  for (double distance_m = 0.0; distance_m < 2.5 * sigma_m; distance_m += 0.03) {
    const double expected = 0.8 * std::exp(-0.5 * distance_m * distance_m / (sigma_m * sigma_m));
    for (int k = 0; k < 8; ++k) {
      // Interpolation between two cells a sigma costs up to an eighth of the curvature.
      EXPECT_NEAR(field.at(spot_m + rotate({distance_m, 0.0}, k * kPi / 4)), expected, 0.06) << distance_m;
    }
  }
  EXPECT_EQ(field.at(spot_m + Point2(10.0, 0.0)), 0.0);
  EXPECT_EQ(field.at(spot_m + Point2(0.0, 5 * sigma_m)), 0.0);
}

TEST(LikelihoodField, TakesTheNearerOfTwoSpots) {
  const LikelihoodField field({{{0.0, 0.0}, 1.0}, {{1.0, 0.0}, 1.0}}, 0.1);
  EXPECT_GT(field.at({0.0, 0.0}), 0.9);
  EXPECT_GT(field.at({1.0, 0.0}), 0.9);
  EXPECT_LT(field.at({0.5, 0.0}), 0.01);
}

TEST(LikelihoodField, OfNothingAndOfOddPlacesIsZero) {
  EXPECT_EQ(LikelihoodField({}, 0.1).at({0.0, 0.0}), 0.0);
  const LikelihoodField field({{{0.0, 0.0}, 1.0}}, 0.1);
  EXPECT_EQ(field.at({NAN, 0.0}), 0.0);
  EXPECT_EQ(field.at({1e300, -1e300}), 0.0);
}

TEST(HillClimbing, FindsTheTopOfAHill) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    const Pose2 top{2 * unit(rng), 2 * unit(rng), unit(rng)};
    const auto score = [&](const Pose2& pose) {
      const double turn_rad = wrap_angle(pose.theta_rad - top.theta_rad);
      return -(pose.translation() - top.translation()).squaredNorm() - 4 * turn_rad * turn_rad;
    };
    EXPECT_THAT(climb({}, score, {0.2, 0.1, 8}), test::IsNearPose(top, 0.002, 0.001));
  }
}

TEST(HillClimbing, StaysWhereNothingIsBetterAndEndsOnAnEndlessSlope) {
  EXPECT_EQ(climb({1.0, 2.0, 0.3}, [](const Pose2&) { return 0.0; }, {}), (Pose2{1.0, 2.0, 0.3}));
  EXPECT_EQ(climb({1.0, 2.0, 0.3}, [](const Pose2&) { return NAN; }, {}), (Pose2{1.0, 2.0, 0.3}));
  const Pose2 far = climb({}, [](const Pose2& pose) { return pose.x_m; }, {0.1, 0.05, 2});
  EXPECT_GT(far.x_m, 50.0);
}

}  // namespace
}  // namespace shapemap::baselines
