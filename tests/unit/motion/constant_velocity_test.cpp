// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion/constant_velocity.hpp"

#include <gmock/gmock.h>

#include <random>

#include "support/matchers.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;

const Pose2 kPose{1.0, 0.5, 0.3};

TEST(Surprise, IsNoneNearWhereTheScanWasToBeExpectedAndNeverMuch) {
  const ExpectedPose expected{kPose};
  EXPECT_EQ(surprise(expected, kPose * Pose2{0.3, 0.2, 20 * kDegree}), 0.0);
  double before = 0.0;
  for (const double off_m : {0.5, 0.8, 1.1, 3.0}) {
    const double now = surprise(expected, kPose * Pose2{0.0, off_m, 0.0});
    EXPECT_GT(now, before);
    before = now;
  }
  EXPECT_GT(surprise(expected, kPose * Pose2{0.0, 0.0, 40 * kDegree}), 1.0);
  EXPECT_DOUBLE_EQ(surprise(expected, kPose * Pose2{100.0, 0.0, 180 * kDegree}), 8.0);
}

TEST(Surprise, IsMoreWhereScansAreUsuallyNearer) {
  const Pose2 found = kPose * Pose2{0.2, 0.0, 10 * kDegree};
  EXPECT_EQ(surprise({kPose, 0.4, 25 * kDegree}, found), 0.0);
  EXPECT_NEAR(surprise({kPose, 0.1, 25 * kDegree}, found), 2.0, 1e-9);
  EXPECT_NEAR(surprise({kPose, 0.1, 5 * kDegree}, found), 4.0, 1e-9);
}

ConstantVelocityPrior after(std::size_t count, double off_m, double off_rad, std::size_t num_jumps = 0) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  ConstantVelocityPrior expectation;
  for (std::size_t i = 0; i < count; ++i) {
    const bool jumps = i < num_jumps;
    expectation.learn({jumps ? 3.0 : off_m * any(rng), 0.0, jumps ? 2.0 : off_rad * any(rng)});
  }
  return expectation;
}

TEST(ConstantVelocityPrior, KnowsNothingOfFew) {
  const ExpectedPose expected = after(20, 0.01, 0.01).at(kPose);
  EXPECT_THAT(expected.pose, HasSameBits(kPose));
  EXPECT_EQ(expected.usual_m, kUsualSurprise_m);
  EXPECT_EQ(expected.usual_rad, kUsualSurprise_rad);
}

/// The usual deviation is twice the one that 95 of 100 are within.
TEST(ConstantVelocityPrior, LearnsWhatIsUsual) {
  const ExpectedPose expected = after(400, 0.08, 4 * kDegree).at(kPose);
  EXPECT_NEAR(expected.usual_m, 2 * 0.95 * 0.08, 0.015);
  EXPECT_NEAR(expected.usual_rad, 2 * 0.95 * 4 * kDegree, 1 * kDegree);
}

TEST(ConstantVelocityPrior, IsNoMoreThanTheWorstAndNoLessThanWhatScansHold) {
  const ExpectedPose wild = after(400, 1.0, 1.0).at(kPose);
  EXPECT_EQ(wild.usual_m, kUsualSurprise_m);
  EXPECT_EQ(wild.usual_rad, kUsualSurprise_rad);
  const ExpectedPose steady = after(400, 1e-4, 1e-4).at(kPose);
  EXPECT_NEAR(steady.usual_m, 0.05, 1e-9);
  EXPECT_NEAR(steady.usual_rad, 25 * kDegree / 8, 1e-9);
}

TEST(ConstantVelocityPrior, FewJumpsChangeLittle) {
  EXPECT_NEAR(after(400, 0.08, 4 * kDegree, 10).at(kPose).usual_m, after(400, 0.08, 4 * kDegree).at(kPose).usual_m,
              0.02);
}

}  // namespace
}  // namespace shapemap
