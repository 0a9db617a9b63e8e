// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/core/pose2.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace shapemap {
namespace {

TEST(Pose2, TurnsThenMoves) {
  const Point2 p = Pose2{1.0, 2.0, kPi / 2} * Point2(1.0, 0.0);
  EXPECT_NEAR(p.x(), 1.0, 1e-15);
  EXPECT_NEAR(p.y(), 3.0, 1e-15);
}

TEST(Pose2, InverseAndCompositionFormAGroup) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> any(-10.0, 10.0);
  for (int i = 0; i < 200; ++i) {
    const Pose2 c_from_b{any(rng), any(rng), any(rng)};
    const Pose2 b_from_a{any(rng), any(rng), any(rng)};
    const Point2 p_in_a(any(rng), any(rng));
    const Point2 composed = (c_from_b * b_from_a) * p_in_a;
    EXPECT_LT((composed - c_from_b * (b_from_a * p_in_a)).norm(), 1e-12);
    const Point2 back = inverse(c_from_b) * (c_from_b * p_in_a);
    EXPECT_LT((back - p_in_a).norm(), 1e-12);
  }
}

TEST(Pose2, AgreesWithAnotherWhereTheMotionBetweenThemIsWithinTheTolerance) {
  const PoseTolerance tolerance{0.5, 10 * kDegree};
  EXPECT_TRUE(agrees({1.0, 2.0, kPi - 0.01}, {1.3, 1.7, -kPi + 0.01}, tolerance)) << "headings go round";
  EXPECT_FALSE(agrees({1.0, 2.0, 0.0}, {1.5, 2.0, 0.0}, tolerance)) << "the limit itself is out";
  EXPECT_FALSE(agrees({1.0, 2.0, 0.0}, {1.0, 2.0, 11 * kDegree}, tolerance));
  EXPECT_TRUE(is_within({0.3, -0.3, -9 * kDegree}, tolerance));
  EXPECT_FALSE(is_within({0.4, -0.4, 0.0}, tolerance));
  EXPECT_FALSE(is_within({0.0, 0.0, -11 * kDegree}, tolerance));
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> any(-0.6, 0.6);
  int num_agreeing = 0;
  for (int i = 0; i < 500; ++i) {
    const Pose2 one{any(rng), any(rng), 0.5 * any(rng)};
    const Pose2 other{any(rng), any(rng), 0.5 * any(rng)};
    EXPECT_EQ(agrees(one, other, tolerance), is_within(inverse(one) * other, tolerance));
    EXPECT_EQ(agrees(one, other, tolerance), agrees(other, one, tolerance));
    num_agreeing += agrees(one, other, tolerance) ? 1 : 0;
  }
  EXPECT_GT(num_agreeing, 50);
}

TEST(WrapAngle, StaysWithinHalfATurnAndEndsOnAnyInput) {
  EXPECT_NEAR(wrap_angle(3 * kPi / 2), -kPi / 2, 1e-15);
  EXPECT_NEAR(wrap_angle(1e9), std::remainder(1e9, 2 * kPi), 0.0);
  EXPECT_TRUE(std::isnan(wrap_angle(std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace shapemap
