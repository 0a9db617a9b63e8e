// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

/// Poses that agree best with what is known of pairs of them.
namespace shapemap {

/// A measured relative pose of two nodes of a pose graph.
struct PoseConstraint {
  std::size_t a = 0;
  std::size_t b = 0;
  Pose2 a_from_b;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, theta), in the frame of `a`
  /// Beyond so many standard deviations a disagreement counts less and less (Cauchy's loss); 0: it counts in full.
  double loss_scale = 0.0;
};

struct PoseGraphSolution {
  std::vector<Pose2> map_from_node;
  double chi_square = 0.0;  ///< sum of squared errors in standard deviations, after the loss
};

/// Least squares over all `constraints`, from `map_from_node`. The first node of each part that hangs together stays
/// where it is. Same input, same bits. Throws std::invalid_argument for a node that does not exist, a covariance that
/// is none, or a pose that is not finite.
PoseGraphSolution solve_pose_graph(const std::vector<Pose2>& map_from_node,
                                   const std::vector<PoseConstraint>& constraints, int max_iterations = 30);

/// Square of the error of one constraint, in standard deviations, without the loss.
double squared_error(const PoseConstraint& constraint, const std::vector<Pose2>& map_from_node);

/// How far `other` is from the pose that a constraint tells, in standard deviations of the place; infinite where it is
/// turned by more than 10 degrees.
double deviations_off(const PoseConstraint& one, const Pose2& other);

/// Whether `other` is the same place, as far as a constraint holds it: within three standard deviations.
bool is_same_place(const PoseConstraint& one, const Pose2& other);

/// For each node the lowest number among the nodes that it hangs together with.
std::vector<std::size_t> connected_components(std::size_t num_nodes, const std::vector<PoseConstraint>& constraints);

/// Per constraint: whether nothing else joins its two nodes, neither directly nor by a detour.
std::vector<bool> bridge_edges(std::size_t num_nodes, const std::vector<PoseConstraint>& constraints);

}  // namespace shapemap
