// SPDX-License-Identifier: GPL-3.0-or-later
#include "motions.hpp"

#include <gmock/gmock.h>

#include <random>

#include "shapemap/core/errors.hpp"
#include "shapemap/io/map_files.hpp"
#include "shapemap/io/trajectory_files.hpp"
#include "support/matchers.hpp"
#include "support/temp_folder.hpp"

namespace shapemap::baselines {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class Motions : public testing::Test {
 protected:
  Motions() {
    for (int i = 0; i < 6; ++i) {
      log_.scans.push_back({100.0 + 0.5 * i, {}, std::nullopt, std::nullopt});
      poses_.push_back({0.3 * i, 0.1 * i * i, wrap_angle(0.9 * i)});
    }
  }

  /// A file of the poses of these positions.
  std::string tum(const std::vector<std::size_t>& indices) const {
    std::vector<PlacedScan> placed;
    for (const std::size_t i : indices) placed.push_back({i, log_.scans[i].timestamp_s, poses_[i], {}});
    return folder_.write("poses.tum", tum_trajectory(placed));
  }

  Pose2 way(std::size_t from, std::size_t to) const { return inverse(poses_[from]) * poses_[to]; }

  test::TempFolder folder_;
  Log log_;
  std::vector<Pose2> poses_;
  MotionOptions options_;
};

TEST_F(Motions, OfNothingAreZeroAndUnsure) {
  const std::vector<Motion> motions = motions_for(log_, {}, {}, options_);
  ASSERT_EQ(motions.size(), 6U);
  for (const Motion& motion : motions) {
    EXPECT_EQ(motion.previous_from_this, Pose2{});
    EXPECT_DOUBLE_EQ(motion.covariance(0, 0), 0.6 * 0.6);
    EXPECT_DOUBLE_EQ(motion.covariance(2, 2), 400 * kDegree * kDegree);
  }
}

TEST_F(Motions, OfPosesLeadOverPositionsWithoutOne) {
  const std::vector<Motion> motions = motions_for(log_, {}, {tum({0, 1, 4, 5}), ""}, options_);
  ASSERT_EQ(motions.size(), 6U);
  EXPECT_THAT(motions[1].previous_from_this, test::IsNearPose(way(0, 1), 1e-8, 1e-8));
  EXPECT_DOUBLE_EQ(motions[1].covariance(0, 0), 0.05 * 0.05);
  EXPECT_EQ(motions[2].previous_from_this, Pose2{});
  EXPECT_DOUBLE_EQ(motions[2].covariance(0, 0), 0.6 * 0.6);
  EXPECT_THAT(motions[4].previous_from_this, test::IsNearPose(way(1, 4), 1e-8, 1e-8));
  EXPECT_THAT(motions[5].previous_from_this, test::IsNearPose(way(4, 5), 1e-8, 1e-8));
}

TEST_F(Motions, OfSelectedPositionsAreComposed) {
  SelectionOptions selection;
  selection.skip = 1;
  selection.every = 2;
  selection.first = 2;
  const std::vector<Motion> motions = motions_for(log_, selection, {tum({0, 1, 2, 3, 4, 5}), ""}, options_);
  ASSERT_EQ(motions.size(), 2U);
  EXPECT_THAT(motions[1].previous_from_this, test::IsNearPose(way(1, 3), 1e-8, 1e-8));
  EXPECT_GT(motions[1].covariance(0, 0), 1.9 * 0.05 * 0.05);
}

TEST_F(Motions, CovariancesComeFromTheirFile) {
  std::vector<TimedMotion> lines;
  for (std::size_t i = 0; i < 6; ++i) {
    const double variance = 0.01 * static_cast<double>(i);
    lines.push_back({log_.scans[i].timestamp_s, {7.0, 8.0, 0.5}, variance * Eigen::Matrix3d::Identity(), ""});
  }
  const std::string path = folder_.write("map.motions", motion_lines(lines));
  const std::vector<Motion> both = motions_for(log_, {}, {tum({0, 1, 2, 3, 4, 5}), path}, options_);
  const std::vector<Motion> alone = motions_for(log_, {}, {"", path}, options_);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_THAT(both[i].previous_from_this, test::IsNearPose(way(i - 1, i), 1e-8, 1e-8));
    EXPECT_EQ(alone[i].previous_from_this, (Pose2{7.0, 8.0, 0.5}));
    EXPECT_EQ(both[i].covariance, lines[i].covariance);
    EXPECT_EQ(alone[i].covariance, lines[i].covariance);
  }
}

TEST_F(Motions, ALineThatIsOfNoPositionIsNamed) {
  const std::string path = folder_.write("poses.tum", "100 0 0 0 0 0 0 1\n100.7 0 0 0 0 0 0 1\n");
  EXPECT_THAT(
      [&] {
        motions_for(log_, {}, {path, ""}, options_);
      },
      ThrowsMessage<InputError>(HasSubstr("poses.tum:2")));
}

TEST_F(Motions, TimesThatRepeatAreTakenInOrder) {
  for (Scan& scan : log_.scans) scan.timestamp_s = 5.0;
  const std::vector<Motion> motions = motions_for(log_, {}, {tum({0, 1, 2, 3, 4, 5}), ""}, options_);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_THAT(motions[i].previous_from_this, test::IsNearPose(way(i - 1, i), 1e-8, 1e-8));
  }
  const std::string some = tum({0, 1, 3, 4, 5});
  EXPECT_THAT(
      [&] {
        motions_for(log_, {}, {some, ""}, options_);
      },
      ThrowsMessage<InputError>(HasSubstr("poses.tum:5: the log repeats")));
}

TEST(ComposedMotion, HasTheCovarianceOfManyDrawnOnes) {
  const Motion a{{1.0, 0.5, 0.8}, Eigen::Vector3d(0.02, 0.005, 0.003).asDiagonal()};
  const Motion b{{2.0, -0.3, -0.4}, Eigen::Vector3d(0.001, 0.02, 0.002).asDiagonal()};
  const Motion both = compose(a, b);
  std::mt19937 rng(11);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto draw = [&](const Motion& motion) {
    const Eigen::Vector3d sigma = motion.covariance.diagonal().cwiseSqrt();
    const Pose2& mean = motion.previous_from_this;
    return Pose2{mean.x_m + sigma.x() * noise(rng), mean.y_m + sigma.y() * noise(rng),
                 mean.theta_rad + sigma.z() * noise(rng)};
  };
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const Pose2 drawn = draw(a) * draw(b);
    const Pose2& mean = both.previous_from_this;
    const Eigen::Vector3d off(drawn.x_m - mean.x_m, drawn.y_m - mean.y_m, wrap_angle(drawn.theta_rad - mean.theta_rad));
    scatter += off * off.transpose() / kDraws;
  }
  EXPECT_LT((scatter - both.covariance).cwiseAbs().maxCoeff(), 0.05 * both.covariance.maxCoeff());
}

}  // namespace
}  // namespace shapemap::baselines
