// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/match_probability.hpp"

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "support/views.hpp"

namespace shapemap {
namespace {

Eigen::Matrix3d covariance_in(const test::World& world, const Pose2& from, const test::Scanner& scanner) {
  const ScanView reference = test::view_from(world, from, scanner, 1);
  const ScanView query = test::view_from(world, from, scanner, 2);
  return pose_covariance(fit_to_lines(reference, query, {}, {}));
}

test::Scanner short_sighted() {
  test::Scanner scanner = test::full_circle();
  scanner.max_range_m = 8.0;
  return scanner;
}

TEST(PoseCovariance, IsSmallInARoom) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Eigen::Matrix3d covariance = covariance_in(test::cluttered_room(seed), {}, short_sighted());
    EXPECT_LT(worst_deviation_m(covariance), 0.05);
    EXPECT_LT(std::sqrt(covariance(2, 2)), 2 * kDegree);
  }
}

TEST(PoseCovariance, IsLargeAlongABareCorridorWhateverTheHeading) {
  for (const double heading_rad : {0.0, 0.5, kPi / 2, -2.0}) {
    const Eigen::Matrix3d covariance = covariance_in(test::bare_corridor(), {0.0, 0.0, heading_rad}, short_sighted());
    EXPECT_GT(worst_deviation_m(covariance), 1.0);
    const Eigen::Matrix2d scans = covariance.topLeftCorner<2, 2>();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(scans);
    EXPECT_LT(std::sqrt(eigen.eigenvalues()(0)), 0.05) << "the walls hold it";
    const Point2 along = rotate({1.0, 0.0}, -heading_rad);
    EXPECT_GT(std::abs(along.dot(eigen.eigenvectors().col(1))), std::cos(5 * kDegree));
  }
}

TEST(PoseCovariance, IsLargeAboutTheCentreOfARoundRoom) {
  const Eigen::Matrix3d round = covariance_in(test::round_room(), {}, short_sighted());
  const Eigen::Matrix3d uneven = covariance_in(test::uneven_room(), {}, short_sighted());
  EXPECT_LT(worst_deviation_m(round), 0.10);
  // Polylines of a circle have corners, which seem to constrain the heading a little.
  EXPECT_GT(std::sqrt(round(2, 2)), 2 * kDegree);
  EXPECT_GT(std::sqrt(round(2, 2)), 5 * std::sqrt(uneven(2, 2)));
}

TEST(PoseCovariance, IsAlwaysPositiveDefinite) {
  std::mt19937 rng(1);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 500; ++round) {
    LineFit fit;
    fit.partners = round % 7 == 0 ? 0 : 1 + round;
    fit.lever_m = round % 5 == 0 ? 0.0 : 10.0 * std::abs(normal(rng));
    for (int k = 0; k < round % 4; ++k) {  // gives matrices of any rank
      const Eigen::Vector3d row(normal(rng), normal(rng), 5.0 * normal(rng));
      fit.information += 100.0 * std::abs(normal(rng)) * row * row.transpose();
    }
    const Eigen::Matrix3d covariance = pose_covariance(fit);
    ASSERT_TRUE(covariance.allFinite()) << round;
    EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-9 * covariance.norm());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
    EXPECT_GT(eigen.eigenvalues().minCoeff(), 0.0) << round;
    EXPECT_GE(worst_deviation_m(covariance), std::sqrt(std::max(covariance(0, 0), covariance(1, 1))) * (1 - 1e-9));
    EXPECT_LE(best_deviation_m(covariance), std::sqrt(std::min(covariance(0, 0), covariance(1, 1))) * (1 + 1e-9));
    const double area = best_deviation_m(covariance) * worst_deviation_m(covariance);
    const double determinant = covariance.topLeftCorner<2, 2>().determinant();
    EXPECT_NEAR(area * area, determinant, 1e-6 * area * area + 1e-12);
  }
}

TEST(PoseCovariance, OfNoFitKnowsNothing) { EXPECT_GT(worst_deviation_m(pose_covariance({})), 1.0); }

TEST(PoseCovariance, TurnsWithTheFrame) {
  LineFit fit;
  fit.partners = 50;
  fit.lever_m = 2.0;
  fit.information.diagonal() << 100.0, 0.0, 300.0;
  const Eigen::Matrix3d covariance = pose_covariance(fit);
  EXPECT_LT(covariance(0, 0), 0.01);
  EXPECT_GT(covariance(1, 1), 1.0);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(0.7), -std::sin(0.7), std::sin(0.7), std::cos(0.7);
  LineFit turned = fit;
  turned.information = turn * fit.information * turn.transpose();
  EXPECT_LT((pose_covariance(turned) - turn * covariance * turn.transpose()).norm(), 1e-6 * covariance.norm());
}

MatchCandidate candidate(double score, double agree_share) {
  MatchCandidate pose;
  pose.score = score;
  pose.visibility.agree = agree_share;
  pose.visibility.hidden = 1.0 - agree_share;
  return pose;
}

TEST(MatchProbability, IsAProbabilityWhateverTheEvidence) {
  for (const double score : {-1e6, -50.0, 0.0, 3.0, 1e6}) {
    for (const double margin : {-1e6, -1.0, 0.0, 1e-12, 0.5, 20.0, 1e6}) {
      for (const double agree : {0.0, 0.5, 1.0}) {
        const double probability = match_probability(candidate(score, agree), margin);
        EXPECT_GE(probability, 0.0);
        EXPECT_LE(probability, 1.0);
      }
    }
  }
  const double of_nothing = match_probability({}, 0.0);
  EXPECT_TRUE(of_nothing >= 0.0 && of_nothing <= 1.0);
}

TEST(MatchProbability, NeverFallsWithMarginScoreOrAgreement) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int round = 0; round < 500; ++round) {
    const double score = 20.0 * unit(rng) - 15.0;
    const double margin = 25.0 * unit(rng) - 4.0;
    const double agree = 0.9 * unit(rng);
    const double before = match_probability(candidate(score, agree), margin);
    EXPECT_GE(match_probability(candidate(score, agree), margin + 3.0 * unit(rng)), before);
    EXPECT_GE(match_probability(candidate(score + 3.0 * unit(rng), agree), margin), before);
    EXPECT_GE(match_probability(candidate(score, agree + 0.1 * unit(rng)), margin), before);
  }
}

TEST(MatchProbability, TellsAClearWinnerFromATie) {
  EXPECT_GT(match_probability(candidate(2.0, 0.7), kFullMargin), 0.9);
  EXPECT_LT(match_probability(candidate(-10.0, 0.1), 0.0), 0.3);
}

TEST(OdometryProbability, RisesAndStaysAProbability) {
  double before = 0.0;
  for (int k = 0; k <= 100; ++k) {
    const double probability = odometry_probability(k / 100.0, 0.0);
    EXPECT_GT(probability, before) << k;
    EXPECT_LT(probability, 1.0) << k;
    before = probability;
  }
}

TEST(OdometryProbability, TrustsWhatMayAsWellBeOfTwoPlaces) {
  EXPECT_GT(odometry_probability(0.5, 0.0), 0.9);
  EXPECT_GT(odometry_probability(0.01, 0.0), 0.5);
  EXPECT_LT(odometry_probability(1e-6, 0.0), 0.1);
}

TEST(OdometryProbability, FallsWithWhatTheyDoNotSee) {
  for (const double match : {0.01, 0.5, 0.99}) {
    const double odds = log_odds_of(odometry_probability(match, 0.0));
    EXPECT_LT(log_odds_of(odometry_probability(match, 0.1)), odds - 0.5) << match;
    EXPECT_LT(log_odds_of(odometry_probability(match, 0.3)), odds - 2.0) << match;
  }
}

TEST(InsufficientView, IsOfTheScanThatSeesLess) {
  test::Scanner narrow = test::half_circle();
  narrow.num_beams = 91;
  narrow.view_rad = 91 * kDegree;
  const ScanView all = test::view_from(test::cluttered_room(1), {});
  const ScanView quarter = test::view_from(test::cluttered_room(1), {}, narrow);
  const ScanView half = test::view_from(test::cluttered_room(1), {}, test::half_circle());
  EXPECT_EQ(insufficient_view(all, all), 0.0);
  EXPECT_EQ(insufficient_view(all, half), 0.0);
  EXPECT_NEAR(insufficient_view(all, quarter), 0.2, 0.03);
  EXPECT_EQ(insufficient_view(quarter, half), insufficient_view(half, quarter));
}

}  // namespace
}  // namespace shapemap
