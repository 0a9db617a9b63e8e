// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

/// A pose graph gives the poses that agree best with measured relative poses.
namespace shapemap {

/// A measured relative pose of two nodes of a pose graph.
struct PoseConstraint {
  std::size_t a = 0;
  std::size_t b = 0;
  Pose2 a_from_b;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, theta), in the frame of `a`
  /// Cauchy's loss makes errors beyond so many standard deviations count less and less; with 0 they count in full.
  double loss_scale = 0.0;
};

struct PoseGraphSolution {
  std::vector<Pose2> map_from_node;
  double chi_square = 0.0;  ///< sum of the squared errors in standard deviations, after the loss
};

/// Solves the least squares of all `constraints`, with `map_from_node` as the initial guess. The first node of each
/// component stays where it is. The same input gives the same bits. Throws std::invalid_argument for a node that does
/// not exist, a covariance that is not positive definite, or a pose that is not finite.
PoseGraphSolution solve_pose_graph(const std::vector<Pose2>& map_from_node,
                                   const std::vector<PoseConstraint>& constraints, int max_iterations = 30);

/// Returns the squared error of one constraint in standard deviations, without the loss.
double squared_error(const PoseConstraint& constraint, const std::vector<Pose2>& map_from_node);

/// Returns the distance of `other` from the pose of a constraint, in standard deviations of its translation. It is
/// infinite if the two headings differ by more than 10 degrees.
double deviations_off(const PoseConstraint& one, const Pose2& other);

/// Returns whether `other` is the same place as the pose of a constraint, within three standard deviations.
bool is_same_place(const PoseConstraint& one, const Pose2& other);

/// Returns for each node the lowest index of a node in its component.
std::vector<std::size_t> connected_components(std::size_t num_nodes, const std::vector<PoseConstraint>& constraints);

/// Returns for each constraint whether it is a bridge, without which its two nodes would be in different components.
std::vector<bool> bridge_edges(std::size_t num_nodes, const std::vector<PoseConstraint>& constraints);

}  // namespace shapemap
