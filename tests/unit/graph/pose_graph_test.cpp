// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/pose_graph.hpp"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "support/matchers.hpp"
#include "support/random_graph.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::IsNearPose;

using Error = Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns the error by its definition: the pose of node b in the frame of node a, minus the measured one.
Error error_of(const PoseConstraint& constraint, const std::vector<Pose2>& poses) {
  const Pose2 found = inverse(poses[constraint.a]) * poses[constraint.b];
  return {found.x_m - constraint.a_from_b.x_m, found.y_m - constraint.a_from_b.y_m,
          std::remainder(found.theta_rad - constraint.a_from_b.theta_rad, 2 * kPi)};
}

double cost_of(const std::vector<PoseConstraint>& constraints, const std::vector<Pose2>& poses) {
  double sum = 0.0;
  for (const PoseConstraint& constraint : constraints) {
    const Error error = error_of(constraint, poses);
    const double squared = error.dot(constraint.covariance.inverse() * error);
    const double scale = constraint.loss_scale * constraint.loss_scale;
    sum += scale > 0.0 ? scale * std::log(1.0 + squared / scale) : squared;
  }
  return sum;
}

/// Solves the graph by dense Gauss-Newton with numerical derivatives, and weights for the loss. Node 0 is fixed.
std::vector<Pose2> by_dense_gauss_newton(std::vector<Pose2> poses, const std::vector<PoseConstraint>& constraints) {
  constexpr double kStep = 1e-6;
  const auto size = static_cast<Eigen::Index>(3 * poses.size());
  const auto moved = [](Pose2 pose, int coordinate, double by) {
    (coordinate == 0 ? pose.x_m : coordinate == 1 ? pose.y_m : pose.theta_rad) += by;
    return pose;
  };
  for (int iteration = 0; iteration < 200; ++iteration) {
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
    for (const PoseConstraint& constraint : constraints) {
      const Error error = error_of(constraint, poses);
      Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3, size);
      for (const std::size_t node : {constraint.a, constraint.b}) {
        for (int c = 0; c < 3; ++c) {
          const Pose2 kept = poses[node];
          poses[node] = moved(kept, c, kStep);
          const Error ahead = error_of(constraint, poses);
          poses[node] = moved(kept, c, -kStep);
          const Error behind = error_of(constraint, poses);
          poses[node] = kept;
          jacobian.col(static_cast<Eigen::Index>(3 * node) + c) = (ahead - behind) / (2 * kStep);
        }
      }
      Eigen::Matrix3d information = constraint.covariance.inverse();
      const double scale = constraint.loss_scale * constraint.loss_scale;
      if (scale > 0.0) information /= 1.0 + error.dot(information * error) / scale;
      hessian += jacobian.transpose() * information * jacobian;
      gradient += jacobian.transpose() * information * error;
    }
    hessian.topLeftCorner<3, 3>() += 1e12 * Eigen::Matrix3d::Identity();
    const Eigen::VectorXd step = hessian.ldlt().solve(-gradient);
    for (std::size_t node = 1; node < poses.size(); ++node) {
      for (int c = 0; c < 3; ++c) poses[node] = moved(poses[node], c, step[static_cast<Eigen::Index>(3 * node) + c]);
    }
    if (step.norm() < 1e-10) break;
  }
  return poses;
}

TEST(SolvePoseGraph, FindsWhatDenseGaussNewtonFinds) {
  std::mt19937 rng(1);
  for (int round = 0; round < 12; ++round) {
    const std::vector<Pose2> truth = test::random_walk(rng, 3 + static_cast<std::size_t>(round) % 6);
    std::vector<PoseConstraint> constraints = test::odometry_and_loops(truth, truth.size(), 0.06, rng);
    if (round % 2 == 1) {
      for (PoseConstraint& constraint : constraints) constraint.loss_scale = 1.5;
    }
    const std::vector<Pose2> start = test::dead_reckoning(constraints, truth.size(), truth[0]);
    const PoseGraphSolution found = solve_pose_graph(start, constraints, 200);
    const std::vector<Pose2> expected = by_dense_gauss_newton(start, constraints);
    EXPECT_NEAR(found.chi_square, cost_of(constraints, expected), 1e-4 * found.chi_square) << round;
    EXPECT_NEAR(found.chi_square, cost_of(constraints, found.map_from_node), 1e-9 * found.chi_square) << round;
    EXPECT_LT(found.chi_square, cost_of(constraints, start)) << round;
    for (std::size_t node = 0; node < truth.size(); ++node) {
      EXPECT_THAT(found.map_from_node[node], IsNearPose(expected[node], 2e-3, 2e-3)) << round << " node " << node;
    }
  }
}

TEST(SolvePoseGraph, RecoversAConsistentGraphExactly) {
  std::mt19937 rng(2);
  for (int round = 0; round < 20; ++round) {
    const std::vector<Pose2> truth = test::random_walk(rng, 30);
    const std::vector<PoseConstraint> constraints = test::odometry_and_loops(truth, 10, 0.0, rng);
    std::vector<Pose2> start = truth;
    for (std::size_t node = 1; node < start.size(); ++node) {
      start[node] = start[node] * test::random_pose(rng, 0.2, 0.1);
    }
    const PoseGraphSolution found = solve_pose_graph(start, constraints, 100);
    EXPECT_LT(found.chi_square, 1e-8);
    for (std::size_t node = 0; node < truth.size(); ++node) {
      EXPECT_THAT(found.map_from_node[node], IsNearPose(truth[node], 1e-5, 1e-5)) << round << " node " << node;
    }
  }
}

TEST(SolvePoseGraph, KeepsTheFirstNodeOfEachComponentAndAllWithoutConstraints) {
  std::mt19937 rng(3);
  const std::vector<Pose2> start = test::random_walk(rng, 9);
  const std::vector<Pose2> wanted = test::random_walk(rng, 9);
  // The components are {1, 4, 6}, {2, 3} and {5, 8}; nodes 0 and 7 are single.
  const std::vector<PoseConstraint> constraints{
      test::measured(wanted, 6, 4, 0.0, rng), test::measured(wanted, 4, 1, 0.0, rng),
      test::measured(wanted, 6, 1, 0.0, rng), test::measured(wanted, 3, 2, 0.0, rng),
      test::measured(wanted, 5, 8, 0.0, rng)};
  const PoseGraphSolution found = solve_pose_graph(start, constraints, 200);
  for (const std::size_t node : {0U, 7U}) EXPECT_THAT(found.map_from_node[node], HasSameBits(start[node]));
  const auto in_part = [&](std::size_t first, std::size_t node) {
    EXPECT_THAT(found.map_from_node[first], IsNearPose(start[first], 0.0, 1e-15));
    EXPECT_THAT(found.map_from_node[node],
                IsNearPose(start[first] * inverse(wanted[first]) * wanted[node], 1e-5, 1e-5));
  };
  in_part(1, 4);
  in_part(1, 6);
  in_part(2, 3);
  in_part(5, 8);
}

TEST(SolvePoseGraph, CauchysLossLimitsTheEffectOfAnOutlier) {
  std::mt19937 rng(4);
  const std::vector<Pose2> truth = test::random_walk(rng, 20);
  std::vector<PoseConstraint> constraints = test::odometry_and_loops(truth, 15, 0.01, rng);
  PoseConstraint outlier = test::measured(truth, 2, 17, 0.0, rng);
  outlier.a_from_b = outlier.a_from_b * Pose2{4.0, -3.0, 0.8};
  constraints.push_back(outlier);
  const auto worst_off_m = [&](double loss_scale) {
    for (PoseConstraint& constraint : constraints) constraint.loss_scale = loss_scale;
    const PoseGraphSolution found = solve_pose_graph(truth, constraints, 100);
    double worst_m = 0.0;
    for (std::size_t node = 0; node < truth.size(); ++node) {
      worst_m = std::max(worst_m, (found.map_from_node[node].translation() - truth[node].translation()).norm());
    }
    return worst_m;
  };
  EXPECT_GT(worst_off_m(0.0), 0.20);
  EXPECT_LT(worst_off_m(2.0), 0.05);
}

TEST(SolvePoseGraph, CrossesTheSeamOfAngles) {
  // The headings run through a full turn, and the initial ones are off by a whole turn.
  std::mt19937 rng(5);
  std::vector<Pose2> truth;
  for (int k = 0; k < 24; ++k)
    truth.push_back({std::cos(15 * k * kDegree), std::sin(15 * k * kDegree), 15 * k * kDegree});
  std::vector<PoseConstraint> constraints;
  for (std::size_t k = 0; k < 24; ++k) constraints.push_back(test::measured(truth, k, (k + 1) % 24, 0.0, rng));
  std::vector<Pose2> start = truth;
  for (std::size_t k = 1; k < 24; ++k) start[k].theta_rad = wrap_angle(truth[k].theta_rad + (k % 2 == 0 ? 0.1 : -0.1));
  const PoseGraphSolution found = solve_pose_graph(start, constraints, 100);
  EXPECT_LT(found.chi_square, 1e-8);
  for (std::size_t k = 0; k < 24; ++k) {
    EXPECT_THAT(found.map_from_node[k], IsNearPose(truth[k], 1e-5, 1e-5));
    EXPECT_LE(std::abs(found.map_from_node[k].theta_rad), kPi);
  }
}

TEST(SolvePoseGraph, WeighsConstraintsByTheirCovariance) {
  PoseConstraint sure{0, 1, {1.0, 0.0, 0.0}, Eigen::Vector3d(0.01, 0.01, 0.01).asDiagonal(), 0.0};
  PoseConstraint vague{0, 1, {2.0, 0.0, 0.0}, Eigen::Vector3d(0.03, 0.01, 0.01).asDiagonal(), 0.0};
  const PoseGraphSolution found = solve_pose_graph({{}, {}}, {sure, vague});
  EXPECT_NEAR(found.map_from_node[1].x_m, 1.25, 1e-3);
  EXPECT_NEAR(found.chi_square, 0.0625 / 0.01 + 0.5625 / 0.03, 1e-3);
}

TEST(SolvePoseGraph, GivesTheSameBitsTwice) {
  std::mt19937 rng(6);
  const std::vector<Pose2> truth = test::random_walk(rng, 200);
  const std::vector<PoseConstraint> constraints = test::odometry_and_loops(truth, 60, 0.03, rng);
  const std::vector<Pose2> start = test::dead_reckoning(constraints, truth.size(), truth[0]);
  const PoseGraphSolution one = solve_pose_graph(start, constraints);
  const PoseGraphSolution two = solve_pose_graph(start, constraints);
  EXPECT_EQ(one.chi_square, two.chi_square);
  for (std::size_t node = 0; node < truth.size(); ++node) {
    EXPECT_THAT(one.map_from_node[node], HasSameBits(two.map_from_node[node]));
  }
}

TEST(SolvePoseGraph, OfNothingIsNothing) {
  EXPECT_TRUE(solve_pose_graph({}, {}).map_from_node.empty());
  const PoseGraphSolution found = solve_pose_graph({{1.0, 2.0, 3.0}}, {});
  EXPECT_THAT(found.map_from_node[0], HasSameBits(Pose2{1.0, 2.0, 3.0}));
  EXPECT_EQ(found.chi_square, 0.0);
}

TEST(SolvePoseGraph, RefusesNodesThatDoNotExistAndNumbersThatAreNone) {
  const std::vector<Pose2> poses(3);
  const PoseConstraint good{0, 1, {1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity(), 0.0};
  EXPECT_NO_THROW(solve_pose_graph(poses, {good}));
  const auto refused = [&](PoseConstraint bad) {
    EXPECT_THROW(solve_pose_graph(poses, {good, bad}), std::invalid_argument);
  };
  refused({0, 3, {}, Eigen::Matrix3d::Identity(), 0.0});
  refused({3, 0, {}, Eigen::Matrix3d::Identity(), 0.0});
  refused({1, 1, {}, Eigen::Matrix3d::Identity(), 0.0});
  refused({0, 1, {}, Eigen::Matrix3d::Zero(), 0.0});
  refused({0, 1, {}, -Eigen::Matrix3d::Identity(), 0.0});
  refused({0, 1, {}, Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal(), 0.0});
  refused({0, 1, {}, Eigen::Matrix3d::Constant(kNan), 0.0});
  refused({0, 1, {}, Eigen::Vector3d(kInfinity, 1.0, 1.0).asDiagonal(), 0.0});
  refused({0, 1, {kInfinity, 0.0, 0.0}, Eigen::Matrix3d::Identity(), 0.0});
  refused({0, 1, {0.0, 0.0, kNan}, Eigen::Matrix3d::Identity(), 0.0});
  EXPECT_THROW(solve_pose_graph({{}, {0.0, kNan, 0.0}}, {good}), std::invalid_argument);
}

TEST(SquaredError, IsInStandardDeviationsAndWithoutTheLoss) {
  std::mt19937 rng(7);
  for (int round = 0; round < 200; ++round) {
    const std::vector<Pose2> poses = test::random_walk(rng, 2);
    PoseConstraint constraint = test::measured(poses, 0, 1, 0.3, rng);
    const Error error = error_of(constraint, poses);
    const double expected = error.dot(constraint.covariance.inverse() * error);
    EXPECT_NEAR(squared_error(constraint, poses), expected, 1e-9 * (1.0 + expected));
    constraint.loss_scale = 0.5;
    EXPECT_NEAR(squared_error(constraint, poses), expected, 1e-9 * (1.0 + expected));
  }
  PoseConstraint off{0, 1, {1.0, 0.0, 0.0}, Eigen::Vector3d(0.04, 1.0, 1.0).asDiagonal(), 0.0};
  EXPECT_NEAR(squared_error(off, {{}, {1.4, 0.0, 0.0}}), 4.0, 1e-12);
}

}  // namespace
}  // namespace shapemap
