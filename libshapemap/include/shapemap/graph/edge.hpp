// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// A pose that node `b` of a graph may have in the frame of node `a`, by a match of their two scans.
struct EdgeCandidate {
  std::size_t a = 0;
  std::size_t b = 0;  ///< the later node
  Pose2 a_from_b;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< of (x, y, theta), in the frame of `a`
  /// The logarithm of odds that it is right, by the two scans alone. Of an odometry edge, up to a constant that all of
  /// its candidates share.
  double score = 0.0;
  double best_deviation_m = 0.0;  ///< best_deviation_m() of the match, where it was asked for: 0 is well held
};

/// All that node `b` may be to node `a`: the next along the way, or one at the same place long before.
struct Edge {
  std::size_t a = 0;
  std::size_t b = 0;                      ///< the later node
  std::vector<EdgeCandidate> candidates;  ///< the best first; none: nothing joins the two
  double probability = 0.0;               ///< that the first candidate is right
  double any_probability = 0.0;           ///< that one of them is, by how well the best fits
  double insufficient_view = 0.0;         ///< insufficient_view() of the two scans

  bool exists() const { return !candidates.empty(); }
};

/// Returns an edge from node `a` to the next, without candidates.
Edge edge_to_next(std::size_t a, double insufficient_view);

/// The first candidates of the edges that tell how the robot usually moves: nine of ten of them at least are right.
std::vector<Pose2> sure_steps(const std::vector<Edge>& edges);

}  // namespace shapemap
