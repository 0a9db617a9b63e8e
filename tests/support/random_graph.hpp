// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <random>
#include <vector>

#include "shapemap/graph/pose_graph.hpp"

/// These pose graphs are drawn at random.
namespace shapemap::test {

inline Pose2 random_pose(std::mt19937& rng, double reach_m, double reach_rad) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double x_m = reach_m * unit(rng);
  const double y_m = reach_m * unit(rng);
  return {x_m, y_m, reach_rad * unit(rng)};
}

/// The standard deviations are between 0.02 and 0.2, and correlated.
inline Eigen::Matrix3d random_covariance(std::mt19937& rng) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = 0.08 * unit(rng);
  return root * root.transpose() + 4e-4 * Eigen::Matrix3d::Identity();
}

/// Walks `num_nodes` steps about a place.
inline std::vector<Pose2> random_walk(std::mt19937& rng, std::size_t num_nodes) {
  std::vector<Pose2> poses{random_pose(rng, 5.0, kPi)};
  while (poses.size() < num_nodes) poses.push_back(poses.back() * random_pose(rng, 1.5, 1.0));
  return poses;
}

/// Measures the relative pose of two nodes of `truth`, with a random error of the size `error`.
inline PoseConstraint measured(const std::vector<Pose2>& truth, std::size_t a, std::size_t b, double error,
                               std::mt19937& rng) {
  return {a, b, inverse(truth[a]) * truth[b] * random_pose(rng, error, error), random_covariance(rng), 0.0};
}

/// Returns constraints between successive nodes, and `num_loops` more between any two of them.
inline std::vector<PoseConstraint> odometry_and_loops(const std::vector<Pose2>& truth, std::size_t num_loops,
                                                      double error, std::mt19937& rng) {
  std::vector<PoseConstraint> constraints;
  for (std::size_t i = 0; i + 1 < truth.size(); ++i) constraints.push_back(measured(truth, i, i + 1, error, rng));
  std::uniform_int_distribution<std::size_t> any(0, truth.size() - 1);
  while (constraints.size() < truth.size() - 1 + num_loops) {
    const std::size_t a = any(rng);
    const std::size_t b = any(rng);
    if (a != b) constraints.push_back(measured(truth, a, b, error, rng));
  }
  return constraints;
}

/// Composes the constraints between successive nodes at the head of `constraints`.
inline std::vector<Pose2> dead_reckoning(const std::vector<PoseConstraint>& constraints, std::size_t num_nodes,
                                         const Pose2& first) {
  std::vector<Pose2> poses{first};
  for (std::size_t i = 0; i + 1 < num_nodes; ++i) poses.push_back(poses.back() * constraints[i].a_from_b);
  return poses;
}

}  // namespace shapemap::test
