// SPDX-License-Identifier: GPL-3.0-or-later
#include "vasco.hpp"

#include <gtest/gtest.h>

#include "shapemap/core/errors.hpp"
#include "support/matchers.hpp"
#include "walks.hpp"

namespace shapemap::baselines {
namespace {

std::vector<Pose2> placed(const std::vector<Scan>& scans, const std::vector<Motion>& motions,
                          const VascoOptions& options = {}) {
  const auto vasco = make_vasco(options, {});
  for (std::size_t i = 0; i < scans.size(); ++i) vasco->add(scans[i], motions[i]);
  return vasco->map_from_robot();
}

TEST(Vasco, FollowsAWalkWithoutOdometry) {
  for (const unsigned seed : {1U, 2U}) {
    const std::vector<Pose2> truth = test::walk(25);
    const std::vector<Pose2> found =
        placed(test::scans_of(truth, seed), std::vector<Motion>(25, test::nothing_known()));
    ASSERT_EQ(found.size(), truth.size());
    EXPECT_EQ(found[0], Pose2{});
    const test::WorstMotion worst = test::worst_motion(truth, found);
    EXPECT_LT(worst.off_m, 0.03) << seed;
    EXPECT_LT(worst.off_rad, 1.0 * kDegree) << seed;
    // The local map keeps the drift small: the error grows less than the steps'.
    EXPECT_THAT(truth[0] * found.back(), shapemap::test::IsNearPose(truth.back(), 0.05, 1.5 * kDegree)) << seed;
  }
}

TEST(Vasco, ReachesFartherWithMoreLevels) {
  const std::vector<Pose2> truth{{0.0, 0.0, 0.0}, {0.45, -0.2, 16 * kDegree}};
  const std::vector<Scan> scans = test::scans_of(truth, 2);
  const std::vector<Motion> motions(2, Motion{Pose2{}, test::covariance(0.5, 30 * kDegree)});
  VascoOptions options;
  options.levels = 5;
  EXPECT_THAT(placed(scans, motions, options)[1], shapemap::test::IsNearPose(truth[1], 0.03, 1 * kDegree));
  options.levels = 1;
  EXPECT_THAT(placed(scans, motions, options)[1],
              ::testing::Not(shapemap::test::IsNearPose(truth[1], 0.1, 3 * kDegree)));
}

TEST(Vasco, BelievesOdometryWhereTheScansDoNotHold) {
  // In a bare corridor nothing but the motion tells how far the robot went.
  const std::vector<Pose2> truth{{0.0, 0.0, 0.0}, {0.8, 0.0, 0.0}};
  std::mt19937 rng(1);
  std::vector<Scan> scans;
  for (const Pose2& pose : truth) {
    scans.push_back(shapemap::test::scan_of(shapemap::test::bare_corridor(), pose, shapemap::test::full_circle(), rng));
  }
  const Pose2 said{0.8, 0.15, 3 * kDegree};  // and the walls tell the rest
  const std::vector<Pose2> found = placed(scans, {{}, {said, test::covariance(0.05, 5 * kDegree)}});
  EXPECT_NEAR(found[1].x_m, 0.8, 0.1);
  EXPECT_NEAR(found[1].y_m, 0.0, 0.03);
  EXPECT_NEAR(found[1].theta_rad, 0.0, 0.5 * kDegree);
}

TEST(Vasco, ACertainMotionIsKept) {
  const std::vector<Pose2> truth = test::walk(2, 0.3);
  const Pose2 said{0.1, 0.1, 0.1};
  const std::vector<Pose2> found = placed(test::scans_of(truth), {{}, {said, Eigen::Matrix3d::Zero()}});
  EXPECT_THAT(found[1], shapemap::test::IsNearPose(said, 1e-3, 1e-3));
}

TEST(Vasco, OfBlindScansKeepsWhatOdometrySays) {
  std::vector<Scan> scans = test::scans_of(test::walk(4));
  scans[0] = scans[2] = shapemap::test::blind_scan();
  const Motion motion{{0.12, 0.0, 0.1}, test::covariance(0.2, 0.2)};
  const std::vector<Pose2> found = placed(scans, std::vector<Motion>(4, motion));
  EXPECT_EQ(found[0], Pose2{});
  EXPECT_THAT(found[1], shapemap::test::IsNearPose(motion.previous_from_this, 1e-12, 1e-12));  // nothing to match yet
  EXPECT_THAT(found[2], shapemap::test::IsNearPose(found[1] * motion.previous_from_this, 1e-12, 1e-12));
}

TEST(Vasco, AJumpInTheOdometryAsksForNoMoreMemory) {
  const std::vector<Scan> scans = test::scans_of(test::walk(3));
  const std::vector<Motion> motions(3, Motion{{1e7, -1e7, 0.0}, test::covariance(1.0, 0.1)});
  const std::vector<Pose2> found = placed(scans, motions);
  EXPECT_NEAR(found[2].x_m, 2e7, 10.0);
}

TEST(Vasco, RefusesBadOptions) {
  VascoOptions options;
  options.levels = 0;
  EXPECT_THROW(make_vasco(options, {}), ConfigError);
}

}  // namespace
}  // namespace shapemap::baselines
