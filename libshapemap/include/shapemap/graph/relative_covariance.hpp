// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/graph/pose_graph.hpp"

namespace shapemap {

/// How well nodes of a solved pose graph are held to each other, by the best path from one to the other alone: no
/// better than that is certain without inverting the whole system, and what else holds them only makes it better.
class RelativeCovariance {
 public:
  /// Throws std::invalid_argument for a constraint of nodes that do not exist.
  RelativeCovariance(const std::vector<Pose2>& map_from_node, const std::vector<PoseConstraint>& constraints);

  /// Of (x, y, theta) of node `b` in the frame of node `a`. Not finite where no path joins the two.
  Eigen::Matrix3d between(std::size_t a, std::size_t b) const;

 private:
  struct Edge {
    std::size_t to;
    std::size_t constraint;
    double length;
  };
  /// For each node, the constraint by which the best path from `a` comes to it.
  std::vector<std::size_t> arrivals(std::size_t a, std::size_t b) const;

  const std::vector<Pose2>& map_from_node_;
  const std::vector<PoseConstraint>& constraints_;
  std::vector<std::vector<Edge>> edges_;
};

}  // namespace shapemap
