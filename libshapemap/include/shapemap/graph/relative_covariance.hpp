// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/graph/pose_graph.hpp"

namespace shapemap {

/// Gives the covariance of the relative pose of two nodes of a solved pose graph, by the shortest path between them
/// alone. This is an upper estimate that needs no inverse of the whole system: all other paths only make it smaller.
class RelativeCovariance {
 public:
  /// Keeps references to both. Throws std::invalid_argument for a constraint of nodes that do not exist.
  RelativeCovariance(const std::vector<Pose2>& map_from_node, const std::vector<PoseConstraint>& constraints);

  /// Returns the covariance of (x, y, theta) of node `b` in the frame of node `a`, in metres and radians. It is
  /// infinite if no path joins the two.
  Eigen::Matrix3d between(std::size_t a, std::size_t b) const;

 private:
  struct Edge {
    std::size_t to;
    std::size_t constraint;
    double length;
  };
  /// Returns for each node the last constraint on the shortest path from `a` to it.
  std::vector<std::size_t> arrivals(std::size_t a, std::size_t b) const;

  const std::vector<Pose2>& map_from_node_;
  const std::vector<PoseConstraint>& constraints_;
  std::vector<std::vector<Edge>> edges_;
};

}  // namespace shapemap
