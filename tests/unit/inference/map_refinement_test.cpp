// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/inference/map_refinement.hpp"

#include <gmock/gmock.h>

#include <random>

#include "support/matchers.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;

/// A walk along half of the ring, with a small error in each pose.
struct Blurred {
  Blurred() {
    std::mt19937 rng(5);
    for (std::size_t n = 1; n < poses.size(); ++n) poses[n] = truth[n] * test::random_pose(rng, 0.12, 2 * kDegree);
    for (std::size_t n = 0; n + 1 < poses.size(); ++n) {
      chain.push_back({n, n + 1, inverse(poses[n]) * poses[n + 1], test::covariance_of(0.2, 3 * kDegree), 0.0});
    }
  }

  std::vector<Pose2> refined(const RefinementOptions& options, int threads = 1) const {
    RunObserver observer;
    return refine_map(views, poses, chain, {{}, options}, {threads, observer}).map_from_node;
  }

  std::vector<Pose2> truth = test::ring_walk(25, 2);
  test::Views views = test::views_along(test::ring_world(1), truth);
  std::vector<Pose2> poses = truth;
  std::vector<PoseConstraint> chain;
};

TEST(RefineMap, BringsPosesThatAreALittleOffToTheTruth) {
  const Blurred map;
  ASSERT_GT(test::worst_off_m(map.poses, map.truth), 0.10);
  const std::vector<Pose2> refined = map.refined({});
  EXPECT_LT(test::worst_off_m(refined, map.truth), 0.06);
  EXPECT_THAT(refined[0], HasSameBits(map.poses[0])) << "the first stays";
}

TEST(RefineMap, WithoutARoundLeavesAllAsItIs) {
  const Blurred map;
  RefinementOptions options;
  options.rounds = 0;
  const std::vector<Pose2> refined = map.refined(options);
  ASSERT_EQ(refined.size(), map.poses.size());
  for (std::size_t n = 0; n < refined.size(); ++n) EXPECT_THAT(refined[n], HasSameBits(map.poses[n]));
}

/// The poses agree with the odometry edges from the start, so these alone change nothing.
TEST(RefineMap, WithoutNeighboursKeepsToTheOdometryEdges) {
  const Blurred map;
  for (const bool none_allowed : {false, true}) {
    RefinementOptions options;
    (none_allowed ? options.least_agree : options.within_m) = none_allowed ? 1.0 : 0.1;
    const std::vector<Pose2> refined = map.refined(options);
    for (std::size_t n = 0; n < refined.size(); ++n) {
      EXPECT_THAT(refined[n], test::IsNearPose(map.poses[n], 1e-6, 1e-6));
    }
  }
}

TEST(RefineMap, DoesNotPullTogetherWhatIsFarOff) {
  Blurred map;
  RefinementOptions options;
  options.most_off_m = 0.01;
  options.rounds = 1;
  EXPECT_GT(test::worst_off_m(map.refined(options), map.truth), 0.10);
}

TEST(RefineMap, IsTheSameToTheBitForAnyNumberOfThreads) {
  const Blurred map;
  RefinementOptions options;
  options.rounds = 1;
  const std::vector<Pose2> one = map.refined(options, 1);
  const std::vector<Pose2> three = map.refined(options, 3);
  for (std::size_t n = 0; n < one.size(); ++n) EXPECT_THAT(three[n], HasSameBits(one[n]));
}

}  // namespace
}  // namespace shapemap
