// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/relative_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "support/random_graph.hpp"

namespace shapemap {
namespace {

Eigen::Matrix3d diagonal(double x_m, double y_m, double theta_rad) {
  return Eigen::Vector3d(x_m * x_m, y_m * y_m, theta_rad * theta_rad).asDiagonal();
}

/// Returns a constraint with the relative pose of two nodes in the map.
PoseConstraint between(const std::vector<Pose2>& map, std::size_t a, std::size_t b, const Eigen::Matrix3d& covariance) {
  return {a, b, inverse(map[a]) * map[b], covariance, 0.0};
}

/// Returns `pose` with a random error of that covariance, added to x, y and theta as in a constraint.
Pose2 disturbed(const Pose2& pose, const Eigen::Matrix3d& covariance, std::mt19937& rng) {
  std::normal_distribution<double> normal;
  const Eigen::Vector3d noise(normal(rng), normal(rng), normal(rng));
  const Eigen::Vector3d error = covariance.llt().matrixL() * noise;
  return {pose.x_m + error.x(), pose.y_m + error.y(), pose.theta_rad + error.z()};
}

/// A sequence of nodes with a constraint between neighbours, some of them from the later node to the earlier one.
struct Way {
  explicit Way(unsigned seed) {
    std::mt19937 rng(seed);
    for (std::size_t i = 0; i < 5; ++i) map.push_back(test::random_pose(rng, 4.0, kPi));
    for (std::size_t i = 0; i + 1 < map.size(); ++i) {
      Eigen::Matrix3d root = diagonal(0.02, 0.05, 0.01);
      root(0, 1) = root(1, 0) = 0.0003;
      root(0, 2) = root(2, 0) = 0.00005;
      const bool is_reversed = (seed + i) % 2 == 0;
      constraints.push_back(is_reversed ? between(map, i + 1, i, root) : between(map, i, i + 1, root));
    }
  }
  std::vector<Pose2> map;
  std::vector<PoseConstraint> constraints;
};

class AlongAWay : public ::testing::TestWithParam<unsigned> {};

/// The covariance is compared to an estimate from many disturbed sequences.
TEST_P(AlongAWay, IsTheSpreadOfManyDisturbedSequences) {
  const Way way(GetParam());
  const std::size_t last = way.map.size() - 1;
  const Eigen::Matrix3d found = RelativeCovariance(way.map, way.constraints).between(0, last);
  const Pose2 expected = inverse(way.map[0]) * way.map[last];
  std::mt19937 rng(11);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  constexpr int kWays = 20000;
  for (int n = 0; n < kWays; ++n) {
    Pose2 there;
    for (std::size_t i = 0; i < last; ++i) {
      const PoseConstraint& c = way.constraints[i];
      const Pose2 a_from_b = disturbed(c.a_from_b, c.covariance, rng);
      there = there * (c.a == i ? a_from_b : inverse(a_from_b));
    }
    const Eigen::Vector3d off(there.x_m - expected.x_m, there.y_m - expected.y_m,
                              wrap_angle(there.theta_rad - expected.theta_rad));
    sum += off * off.transpose();
  }
  const Eigen::Matrix3d spread = sum / kWays;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(found(i, j), spread(i, j), 0.05 * std::sqrt(spread(i, i) * spread(j, j))) << i << " " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, AlongAWay, ::testing::Values(1U, 2U, 3U));

TEST(RelativeCovariance, IsThatOfTheConstraintBetweenNeighbours) {
  const Way way(1);
  const PoseConstraint& c = way.constraints[0];
  ASSERT_EQ(c.a, 0U);
  EXPECT_TRUE(RelativeCovariance(way.map, way.constraints).between(c.a, c.b).isApprox(c.covariance, 1e-9));
}

TEST(RelativeCovariance, TakesTheShorterPath) {
  const std::vector<Pose2> map{{}, {1, 0, 0}, {2, 0, 0}};
  std::vector<PoseConstraint> constraints{between(map, 0, 1, diagonal(0.01, 0.01, 0.001)),
                                          between(map, 1, 2, diagonal(0.01, 0.01, 0.001)),
                                          between(map, 0, 2, diagonal(0.5, 0.5, 0.1))};
  EXPECT_LT(RelativeCovariance(map, constraints).between(0, 2)(0, 0), 0.001);
  constraints[2].covariance = diagonal(0.005, 0.005, 0.0005);
  EXPECT_TRUE(RelativeCovariance(map, constraints).between(0, 2).isApprox(constraints[2].covariance, 1e-9));
}

TEST(RelativeCovariance, OfNodesThatNothingJoinsIsNotFinite) {
  const std::vector<Pose2> map{{}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<PoseConstraint> constraints{between(map, 0, 1, diagonal(0.01, 0.01, 0.001))};
  const RelativeCovariance covariance(map, constraints);
  EXPECT_FALSE(covariance.between(0, 2).allFinite());
  EXPECT_TRUE(covariance.between(1, 1).isZero());
}

TEST(RelativeCovariance, RefusesNodesThatDoNotExist) {
  const std::vector<Pose2> map{{}};
  const std::vector<PoseConstraint> constraints{{0, 1, {}, Eigen::Matrix3d::Identity(), 0.0}};
  EXPECT_THROW(RelativeCovariance(map, constraints), std::invalid_argument);
}

}  // namespace
}  // namespace shapemap
