// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/motion/motion_prior.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "shapemap/matching/match_search.hpp"
#include "support/matchers.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

/// The robot goes forward by about a metre, turning a little.
std::vector<Pose2> of_a_robot(std::size_t count, std::mt19937& rng) {
  std::normal_distribution<double> normal;
  std::vector<Pose2> motions;
  for (std::size_t i = 0; i < count; ++i) {
    motions.push_back({1.0 + 0.1 * normal(rng), 0.05 * normal(rng), 5 * kDegree * normal(rng)});
  }
  return motions;
}

TEST(MotionPrior, KnowsNothingOfNothing) {
  for (const Pose2& motion : {Pose2{}, Pose2{3.0, -2.0, 1.0}, Pose2{1e6, 0.0, 3.0}}) {
    EXPECT_EQ(MotionPrior().surprise(motion), 0.0);
  }
}

TEST(MotionPrior, ExpectsWhatWasSeen) {
  std::mt19937 rng(1);
  const MotionPrior prior(of_a_robot(200, rng));
  const double usual = prior.surprise({1.0, 0.0, 0.0});
  EXPECT_LT(usual, 0.3);
  for (const Pose2& motion : {Pose2{-1.0, 0.0, 0.0}, Pose2{0.0, 1.0, 0.0}, Pose2{3.0, 0.0, 0.0},
                              Pose2{1.0, 0.0, 170 * kDegree}, Pose2{0.0, 0.0, 0.0}}) {
    EXPECT_GT(prior.surprise(motion), usual + 2.0) << motion.x_m << ' ' << motion.y_m << ' ' << motion.theta_rad;
  }
}

TEST(MotionPrior, TellsTheMoreTheMoreIsKnownAndNeverMuch) {
  std::mt19937 rng(2);
  const Pose2 unheard{-4.0, 0.0, 180 * kDegree};
  double before = 0.0;
  for (const std::size_t count : {0U, 3U, 12U, 50U, 1000U}) {
    const double surprise = MotionPrior(of_a_robot(count, rng)).surprise(unheard);
    EXPECT_GE(surprise, before) << count;
    before = surprise;
  }
  EXPECT_LT(before, 12.0);
}

/// A quarter of a metre more is unusual for a robot that goes by decimetres, and little for one that goes by metres.
TEST(MotionPrior, IsAsExactAsStepsAreShort) {
  const auto surprise_by_more = [](double step_m) {
    std::vector<Pose2> motions;
    for (int i = 0; i < 60; ++i) motions.push_back({step_m + 0.002 * i, 0.0, 0.0});
    return MotionPrior(motions).surprise({step_m + 0.06 + 0.3, 0.0, 0.0});
  };
  EXPECT_GT(surprise_by_more(0.1), 2.0);
  EXPECT_LT(surprise_by_more(1.5), 1.0);
}

TEST(MotionPrior, OfNineMotionsOneInSixWouldBeOfANewKind) {
  std::mt19937 rng(2);
  const double surprise = MotionPrior(of_a_robot(9, rng)).surprise({-6.0, 0.0, 180 * kDegree});
  EXPECT_NEAR(surprise, 3.0 * std::log(6.0), 0.3);
}

/// A robot that turns as it likes and goes any way is surprised by no such motion.
TEST(MotionPrior, LearnsLittleOfAnyMotion) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> any(-kPi, kPi);
  std::vector<Pose2> motions;
  for (int i = 0; i < 500; ++i) {
    const double direction_rad = any(rng);
    motions.push_back({1.5 * std::cos(direction_rad), 1.5 * std::sin(direction_rad), any(rng)});
  }
  const MotionPrior prior(motions);
  for (double angle_rad = -3.0; angle_rad < 3.0; angle_rad += 0.5) {
    EXPECT_LT(prior.surprise({1.5 * std::cos(angle_rad), 1.5 * std::sin(angle_rad), -angle_rad}), 1.5);
  }
}

TEST(MotionPrior, AStepOfNoLengthHasNoDirection) {
  std::mt19937 rng(4);
  const MotionPrior prior(of_a_robot(100, rng));
  EXPECT_NEAR(prior.surprise({1e-9, 0.0, 0.0}), prior.surprise({-1e-9, 0.0, 0.0}), 1e-6);
  EXPECT_LT(prior.surprise({0.5, 0.0, 0.0}) + 2.0, prior.surprise({-0.5, 0.0, 0.0}));
}

TEST(FindUsualCandidates, AreThoseOfAnyOtherSearchWhereNothingIsKnown) {
  const test::World world = test::strange_place(3);
  const Pose2 truth{0.4, -0.2, 50 * kDegree};
  const ScanView reference = test::view_from(world, {});
  const ScanView query = test::view_from(world, truth, test::full_circle(), 2);
  const std::vector<MatchCandidate> found = find_usual_candidates(reference, query, {}, MotionPrior());
  ASSERT_FALSE(found.empty());
  EXPECT_THAT(found.front().ref_from_query, test::IsNearPose(truth, 0.05, kDegree));
  EXPECT_NEAR(found.front().score, candidate_at(reference, query, found.front().ref_from_query, {}).score, 0.5);
}

/// Along a bare corridor nothing but the motion prior tells how far the robot went.
TEST(FindUsualCandidates, AlongABareCorridorAreWhereTheRobotUsuallyGoes) {
  const test::World corridor = test::bare_corridor();
  const ScanView reference = test::view_from(corridor, {0.0, 0.1, 0.0}, test::half_circle());
  const ScanView query = test::view_from(corridor, {1.5, 0.0, 0.0}, test::half_circle(), 2);
  for (const double step_m : {0.5, 1.5, 2.5}) {
    const MotionPrior prior(std::vector<Pose2>(100, Pose2{step_m, 0.0, 0.0}));
    const std::vector<MatchCandidate> found = find_usual_candidates(reference, query, {}, prior);
    ASSERT_FALSE(found.empty());
    EXPECT_THAT(found.front().ref_from_query, test::IsNearPose(Pose2{step_m, -0.1, 0.0}, 0.35, 3 * kDegree)) << step_m;
  }
}

TEST(FindUsualCandidates, ScoreLessByTheSurprise) {
  const test::World world = test::strange_place(4);
  const Pose2 truth{0.3, 0.2, 0.0};
  const ScanView reference = test::view_from(world, {});
  const ScanView query = test::view_from(world, truth, test::full_circle(), 2);
  const MotionPrior elsewhere(std::vector<Pose2>(50, Pose2{-3.0, 0.0, 180 * kDegree}));
  const std::vector<MatchCandidate> usual = find_usual_candidates(reference, query, {}, MotionPrior());
  const std::vector<MatchCandidate> found = find_usual_candidates(reference, query, {}, elsewhere);
  ASSERT_FALSE(found.empty());
  EXPECT_THAT(found.front().ref_from_query, test::IsNearPose(truth, 0.05, kDegree)) << "the scans tell more";
  EXPECT_NEAR(found.front().score, usual.front().score - elsewhere.surprise(truth), 0.3);
}

}  // namespace
}  // namespace shapemap
