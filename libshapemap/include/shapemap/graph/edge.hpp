// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// A candidate is a pose that node `b` of a graph may have in the frame of node `a`, by a match of their two scans.
struct EdgeCandidate {
  std::size_t a = 0;
  std::size_t b = 0;  ///< the later node
  Pose2 a_from_b;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, theta), in the frame of `a`
  /// The log odds that the candidate is right, by the two scans alone. All candidates of an odometry edge share an
  /// unknown constant in it.
  double score = 0.0;
  double best_deviation_m = 0.0;  ///< best_deviation_m() of the match where it is needed; 0 means well constrained
};

/// An edge has the candidates for the relative pose of two nodes: consecutive ones, or two that a loop may join.
struct Edge {
  std::size_t a = 0;
  std::size_t b = 0;                      ///< the later node
  std::vector<EdgeCandidate> candidates;  ///< best first; without any, the edge joins nothing
  double probability = 0.0;               ///< probability that the first candidate is right
  double any_probability = 0.0;           ///< probability that any candidate is right, by the fit of the best
  double insufficient_view = 0.0;         ///< insufficient_view() of the two scans

  bool exists() const { return !candidates.empty(); }
};

/// Returns an edge without candidates from node `a` to the next.
Edge edge_to_next(std::size_t a, double insufficient_view);

/// Returns the first candidates of the edges that are more than 0.9 probable, from which usual motions can be learned.
std::vector<Pose2> sure_steps(const std::vector<Edge>& edges);

}  // namespace shapemap
