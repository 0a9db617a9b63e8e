// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "mrpt_icp.hpp"
#include "mrpt_rbpf.hpp"
#include "shapemap/core/errors.hpp"
#include "support/matchers.hpp"
#include "walks.hpp"

namespace shapemap::baselines {
namespace {

std::vector<Pose2> placed(SlamMethod& method, const std::vector<Scan>& scans, const std::vector<Motion>& motions) {
  for (std::size_t i = 0; i < scans.size(); ++i) method.add(scans[i], motions[i]);
  return method.map_from_robot();
}

std::vector<Motion> motions_of(const std::vector<Pose2>& poses, const Eigen::Matrix3d& covariance) {
  std::vector<Motion> motions(1);
  for (std::size_t i = 1; i < poses.size(); ++i) motions.push_back({inverse(poses[i - 1]) * poses[i], covariance});
  return motions;
}

/// Each pose in the frame of the first.
std::vector<Pose2> from_first(std::vector<Pose2> poses) {
  const Pose2 first_from_map = inverse(poses.front());
  for (Pose2& pose : poses) pose = first_from_map * pose;
  return poses;
}

/// Fewer particles, for tests that do not ask for the right pose.
RbpfOptions small_filter() {
  RbpfOptions options;
  options.particles = 6;
  options.samples = 40;
  options.longest_beam_m = 10.0;
  options.update_m = 0.0;
  return options;
}

TEST(MrptIcp, FollowsSmallStepsWithoutOdometry) {
  const std::vector<Pose2> truth = test::walk(40);
  const auto icp = make_mrpt_icp({}, {});
  const std::vector<Pose2> found =
      placed(*icp, test::scans_of(truth), std::vector<Motion>(truth.size(), test::nothing_known()));
  ASSERT_EQ(found.size(), truth.size());
  const test::WorstMotion worst = test::worst_motion(truth, found);
  EXPECT_LT(worst.off_m, 0.06);
  EXPECT_LT(worst.off_rad, 2 * kDegree);
}

TEST(MrptIcp, CorrectsOdometryAndKeepsItForBlindScans) {
  const std::vector<Pose2> truth = test::walk(12, 0.4);
  std::vector<Motion> motions = motions_of(truth, Eigen::Matrix3d::Zero());
  for (Motion& motion : motions) motion.previous_from_this = motion.previous_from_this * Pose2{0.05, -0.04, 0.03};
  std::vector<Scan> scans = test::scans_of(truth);
  scans.back() = shapemap::test::blind_scan();
  const auto icp = make_mrpt_icp({}, {});
  std::vector<Pose2> found = placed(*icp, scans, motions);
  EXPECT_THAT(inverse(found[10]) * found[11], shapemap::test::IsNearPose(motions[11].previous_from_this, 1e-6, 1e-6));
  found.pop_back();
  const std::vector<Pose2> seen(truth.begin(), truth.end() - 1);
  const test::WorstMotion worst = test::worst_motion(seen, found);
  EXPECT_LT(worst.off_m, 0.04);
  EXPECT_LT(worst.off_rad, 1.5 * kDegree);
}

TEST(MrptIcp, TakesAPositionsSubScansAsOne) {
  shapemap::test::Scanner scanner;
  scanner.num_sweeps = 4;
  scanner.view_rad = 100 * kDegree;
  scanner.num_beams = 100;
  const std::vector<Pose2> truth = test::walk(15);
  const shapemap::test::World world = shapemap::test::cluttered_room(3);
  std::vector<Scan> scans;
  for (const Pose2& pose : truth) scans.push_back(shapemap::test::scan_of(world, pose, scanner));
  const auto icp = make_mrpt_icp({}, {});
  const std::vector<Pose2> found = placed(*icp, scans, std::vector<Motion>(truth.size(), test::nothing_known()));
  EXPECT_LT(test::worst_motion(truth, found).off_m, 0.06);
}

TEST(MrptRbpf, UpdatesWithExactlyZeroOdometry) {
  const std::vector<Pose2> truth = test::walk(12);
  RbpfOptions options = small_filter();
  options.particles = 15;
  options.samples = 400;
  const auto filter = make_mrpt_rbpf(options, 1);
  const std::vector<Pose2> found =
      placed(*filter, test::scans_of(truth), std::vector<Motion>(truth.size(), test::nothing_known()));
  ASSERT_EQ(found.size(), truth.size());
  EXPECT_THAT(truth[0] * from_first(found).back(), shapemap::test::IsNearPose(truth.back(), 0.25, 8 * kDegree));
}

TEST(MrptRbpf, TakesTheMotionsCovarianceForItsMotionModel) {
  const std::vector<Pose2> truth = test::walk(6);
  const std::vector<Scan> scans = test::scans_of(truth);
  // What is certain is not corrected, whatever the scans say; sure in one direction only, just in that.
  std::vector<Motion> motions = motions_of(truth, Eigen::Matrix3d::Zero());
  for (Motion& motion : motions) motion.previous_from_this = motion.previous_from_this * Pose2{0.1, 0.1, 0.0};
  const auto certain = make_mrpt_rbpf(small_filter(), 1);
  const std::vector<Pose2> kept = placed(*certain, scans, motions);
  for (std::size_t i = 1; i < kept.size(); ++i) {
    EXPECT_THAT(inverse(kept[i - 1]) * kept[i], shapemap::test::IsNearPose(motions[i].previous_from_this, 1e-3, 1e-3));
  }
  for (Motion& motion : motions) motion.covariance = Eigen::Vector3d(0.04, 0.0, 0.0).asDiagonal();
  const auto sideways = make_mrpt_rbpf(small_filter(), 1);
  const std::vector<Pose2> moved = placed(*sideways, scans, motions);
  double farthest_m = 0.0;
  for (std::size_t i = 1; i < moved.size(); ++i) {
    const Pose2 way = inverse(moved[i - 1]) * moved[i];
    EXPECT_NEAR(way.y_m, motions[i].previous_from_this.y_m, 1e-3);
    EXPECT_NEAR(way.theta_rad, motions[i].previous_from_this.theta_rad, 1e-3);
    farthest_m = std::max(farthest_m, std::abs(way.x_m - motions[i].previous_from_this.x_m));
  }
  EXPECT_GT(farthest_m, 0.02);
}

TEST(MrptRbpf, SameSeedSamePosesAndAnotherSeedOthers) {
  const std::vector<Pose2> truth = test::walk(6);
  const std::vector<Scan> scans = test::scans_of(truth);
  const std::vector<Motion> motions(truth.size(), test::nothing_known());
  const auto with_seed = [&](int seed) { return placed(*make_mrpt_rbpf(small_filter(), seed), scans, motions); };
  const std::vector<Pose2> first = with_seed(7);
  const std::vector<Pose2> again = with_seed(7);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_THAT(again[i], shapemap::test::HasSameBits(first[i]));
  EXPECT_FALSE(with_seed(8).back() == first.back());
}

TEST(MrptRbpf, AddsTheMotionsOfBlindScansToTheNext) {
  const std::vector<Pose2> truth = test::walk(6);
  std::vector<Scan> scans = test::scans_of(truth);
  scans[2] = scans[3] = scans[5] = shapemap::test::blind_scan();
  const Eigen::Matrix3d nearly_certain = test::covariance(0.001, 0.001);
  const auto filter = make_mrpt_rbpf(small_filter(), 1);
  const std::vector<Pose2> found = from_first(placed(*filter, scans, motions_of(truth, nearly_certain)));
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_THAT(truth[0] * found[i], shapemap::test::IsNearPose(truth[i], 0.02, 1 * kDegree)) << i;
  }
}

/// Where odometry is sure and the robot hardly moves, odometry is the answer; it then goes on from there.
TEST(MrptRbpf, PassesOverScansOfTheSamePlace) {
  const std::vector<Pose2> truth = test::walk(9);
  const std::vector<Scan> scans = test::scans_of(truth);
  RbpfOptions options = small_filter();
  options.update_m = 0.25;
  options.update_rad = kPi;
  std::vector<Motion> motions = motions_of(truth, test::covariance(0.02, 0.01));
  for (Motion& motion : motions) motion.previous_from_this = motion.previous_from_this * Pose2{0.01, 0.02, 0.0};
  const std::vector<Pose2> found = placed(*make_mrpt_rbpf(options, 1), scans, motions);
  ASSERT_EQ(found.size(), truth.size());
  std::size_t num_passed = 0;
  for (std::size_t i = 1; i < found.size(); ++i) {
    const Pose2 off = inverse(motions[i].previous_from_this) * inverse(found[i - 1]) * found[i];
    if (off.translation().norm() < 1e-9 && std::abs(off.theta_rad) < 1e-9) ++num_passed;
  }
  EXPECT_GT(num_passed, 2U);
  EXPECT_LT(num_passed, found.size() - 2);
  const std::vector<Motion> unknown(truth.size(), test::nothing_known());
  const std::vector<Pose2> all = placed(*make_mrpt_rbpf(options, 1), scans, unknown);
  const std::vector<Pose2> same = placed(*make_mrpt_rbpf(small_filter(), 1), scans, unknown);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_THAT(all[i], shapemap::test::HasSameBits(same[i]));
}

TEST(MrptRbpf, StopsBeforeMemoryEnds) {
  const std::vector<Scan> scans = test::scans_of(test::walk(3));
  const auto filter = make_mrpt_rbpf(small_filter(), 1);
  filter->add(scans[0], {});
  filter->add(scans[1], {{0.12, 0.0, 0.0}, test::covariance(0.01, 0.01)});
  EXPECT_THROW(filter->add(scans[2], {{1e6, 0.0, 0.0}, test::covariance(0.01, 0.01)}), CannotGoOn);
  EXPECT_EQ(filter->map_from_robot().size(), 2U);
}

}  // namespace
}  // namespace shapemap::baselines
