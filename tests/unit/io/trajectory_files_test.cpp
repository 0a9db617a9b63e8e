// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/trajectory_files.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "shapemap/core/errors.hpp"
#include "shapemap/io/map_files.hpp"
#include "support/matchers.hpp"
#include "support/temp_folder.hpp"

namespace shapemap {
namespace {

using test::IsNearPose;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<TimedMotion> some_motions(unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<TimedMotion> motions;
  for (int i = 0; i < 20; ++i) {
    TimedMotion motion;
    motion.timestamp_s = 1.5e9 + i / 3.0;
    motion.previous_from_this = {noise(rng), noise(rng), wrap_angle(3 * noise(rng))};
    Eigen::Matrix3d root;
    for (Eigen::Index k = 0; k < 9; ++k) root(k) = 0.1 * noise(rng);
    motion.covariance = root * root.transpose();
    motion.covariance.triangularView<Eigen::StrictlyLower>() = motion.covariance.transpose();
    motions.push_back(motion);
  }
  return motions;
}

class TrajectoryFiles : public testing::Test {
 protected:
  std::string write(const std::string& content) const { return folder_.write("file.txt", content); }

  test::TempFolder folder_;
};

TEST_F(TrajectoryFiles, MotionsReadBackToTheBit) {
  const std::vector<TimedMotion> motions = some_motions(3);
  const std::vector<TimedMotion> read = read_motions(write(motion_lines(motions)));
  ASSERT_EQ(read.size(), motions.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].timestamp_s, motions[i].timestamp_s);
    EXPECT_THAT(read[i].previous_from_this, test::HasSameBits(motions[i].previous_from_this));
    EXPECT_EQ(read[i].covariance, motions[i].covariance);
    EXPECT_THAT(read[i].where, HasSubstr("file.txt:" + std::to_string(i + 2)));  // after the heading
  }
}

TEST_F(TrajectoryFiles, MotionsAreTheUpperTriangleRowByRow) {
  const TimedMotion motion = read_motions(write("# heading\n\n7 1 2 0.5 4 0.1 0.2 5 0.3 6 # remark\r\n")).at(0);
  EXPECT_EQ(motion.timestamp_s, 7.0);
  EXPECT_EQ(motion.previous_from_this, (Pose2{1.0, 2.0, 0.5}));
  Eigen::Matrix3d expected;
  expected << 4.0, 0.1, 0.2, 0.1, 5.0, 0.3, 0.2, 0.3, 6.0;
  EXPECT_EQ(motion.covariance, expected);
}

TEST_F(TrajectoryFiles, BadMotionsAreNamedWithFileAndLine) {
  const auto fails_with = [&](const std::string& content, const std::string& why) {
    EXPECT_THAT([&] { read_motions(write(content)); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("file.txt"), HasSubstr(why))));
  };
  const std::string good = "1 0 0 0 1 0 0 1 0 1\n";
  fails_with("", "file.txt");
  fails_with("# nothing\n", "no motion");
  fails_with(good + "2 0 0 0 1 0 0 1 0\n", ":2: expected 'timestamp_s x_m");
  fails_with(good + "2 0 0 0 1 0 0 1 0 1 1\n", ":2");
  fails_with("1 0 x 0 1 0 0 1 0 1\n", ":1: y_m is 'x'");
  fails_with("1 0 0 0 nan 0 0 1 0 1\n", ":1: xx is 'nan'");
  fails_with("1 0 0 0 -1 0 0 1 0 1\n", ":1: xx xy xt yy yt tt is no covariance");
  fails_with("1 0 0 0 1 2 0 1 0 1\n", ":1: xx xy xt yy yt tt is no covariance");
  EXPECT_THROW(read_motions(folder_.path("missing")), InputError);
}

TEST_F(TrajectoryFiles, TumLinesOfOursReadBack) {
  std::vector<PlacedScan> placed;
  for (int i = 0; i < 12; ++i) placed.push_back({0, 100.0 + i, {0.1 * i, -0.2 * i, wrap_angle(0.7 * i)}, {}});
  const std::vector<TimedPose> poses = read_tum_trajectory(write(tum_trajectory(placed)));
  ASSERT_EQ(poses.size(), placed.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].timestamp_s, placed[i].timestamp_s);
    EXPECT_THAT(poses[i].map_from_robot, IsNearPose(placed[i].map_from_robot, 1e-8, 1e-10));
  }
}

TEST_F(TrajectoryFiles, BadTumLinesAreNamedWithFileAndLine) {
  const auto fails_with = [&](const std::string& content, const std::string& why) {
    EXPECT_THAT([&] { read_tum_trajectory(write(content)); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("file.txt"), HasSubstr(why))));
  };
  fails_with("# t x y z qx qy qz qw\n", "no pose");
  fails_with("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n", ":2: expected 't x y z");
  fails_with("1 0 0 0 0 0 0 one\n", ":1: qw is 'one'");
  fails_with("1 0 0 0 0 0 0 0\n", ":1: qx qy qz qw is no turn");
}

TEST(Motions, AreThoseBetweenPlacedScansAfterAZeroForTheFirst) {
  MapResult result;
  result.largest_component = 0;
  result.components.emplace_back();
  for (std::size_t i = 0; i < 3; ++i) {
    ScanResult scan;
    scan.scan_index = i;
    scan.match.covariance = Eigen::Matrix3d::Identity() * static_cast<double>(i);
    result.scans.push_back(scan);
  }
  // The second scan of the log has no pose.
  result.components[0].scans.push_back({0, 10.0, {1.0, 2.0, kPi / 2}, {}});
  result.components[0].scans.push_back({2, 12.0, {1.0, 5.0, kPi}, {}});
  const std::vector<TimedMotion> motions = motions_of(result);
  ASSERT_EQ(motions.size(), 2U);
  EXPECT_EQ(motions[0].timestamp_s, 10.0);
  EXPECT_EQ(motions[0].previous_from_this, Pose2{});
  EXPECT_EQ(motions[0].covariance, Eigen::Matrix3d::Zero());
  EXPECT_EQ(motions[1].timestamp_s, 12.0);
  EXPECT_THAT(motions[1].previous_from_this, IsNearPose(Pose2{3.0, 0.0, kPi / 2}, 1e-12, 1e-12));
  EXPECT_EQ(motions[1].covariance, Eigen::Matrix3d::Identity() * 2.0);

  result.scans[2].match.covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
  result.scans[2].match.status = MatchStatus::kOk;
  EXPECT_THROW(motions_of(result), ConfigError);
  result.scans[2].match.status = MatchStatus::kNoCandidates;
  EXPECT_EQ(motions_of(result)[1].covariance, Eigen::Matrix3d::Identity()) << "loops alone put it there";

  result.scans[2].paper.emplace().status = PaperStatus::kOk;
  EXPECT_THROW(motions_of(result), ConfigError) << "the paper's method knows no covariances";
  result.scans[2].paper->status = PaperStatus::kNoCorrespondences;
  EXPECT_EQ(motions_of(result)[1].covariance, Eigen::Matrix3d::Identity());
}

/// A keyframe, and two scans that are matched with it.
struct Siblings : testing::Test {
  Siblings() {
    result.largest_component = 0;
    result.components.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      ScanResult scan;
      scan.scan_index = i;
      scan.component = 0;
      scan.is_keyframe = i == 0;
      scan.match.covariance = Eigen::Vector3d(1e-4, 4e-4, 1e-5).asDiagonal();
      scan.match.ranked.emplace_back();
      scan.match.ranked.front().ref_from_query = poses[i];
      result.scans.push_back(scan);
      result.components[0].scans.push_back({i, static_cast<double>(i), poses[i], {}});
    }
  }
  std::array<Pose2, 3> poses{Pose2{}, Pose2{0.5, 0.1, 1.2}, Pose2{0.9, -0.4, 1.9}};
  MapResult result;
};

TEST_F(Siblings, MotionBetweenThemErrsByBothMatches) {
  const std::vector<TimedMotion> motions = motions_of(result);
  EXPECT_EQ(motions[1].covariance, result.scans[1].match.covariance) << "from the keyframe itself";
  std::mt19937 rng(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto disturbed = [&](const Pose2& pose) {
    return Pose2{pose.x_m + 0.01 * noise(rng), pose.y_m + 0.02 * noise(rng),
                 pose.theta_rad + std::sqrt(1e-5) * noise(rng)};
  };
  constexpr int kDraws = 20000;
  Eigen::Matrix3d sampled = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Pose2 motion = inverse(disturbed(poses[1])) * disturbed(poses[2]);
    const Pose2& mean = motions[2].previous_from_this;
    const Eigen::Vector3d off(motion.x_m - mean.x_m, motion.y_m - mean.y_m,
                              wrap_angle(motion.theta_rad - mean.theta_rad));
    sampled += off * off.transpose() / kDraws;
  }
  EXPECT_LT((motions[2].covariance - sampled).norm(), 0.05 * sampled.norm());
}

TEST_F(Siblings, SomeOfThePlacedScansHaveMotionsAmongThemselves) {
  const std::vector<PlacedScan>& placed = result.components[0].scans;
  const std::vector<TimedMotion> motions = motions_of(result, {placed[1], placed[2]});
  ASSERT_EQ(motions.size(), 2U);
  EXPECT_EQ(motions[0].timestamp_s, 1.0);
  EXPECT_EQ(motions[0].covariance, Eigen::Matrix3d::Zero());
  EXPECT_THAT(motions[1].previous_from_this, IsNearPose(inverse(poses[1]) * poses[2], 1e-12, 1e-12));
}

}  // namespace
}  // namespace shapemap
