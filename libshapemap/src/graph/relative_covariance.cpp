// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/relative_covariance.hpp"
#include "graph_numbers.hpp"

#include <functional>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>

namespace shapemap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

double length_of(const Eigen::Matrix3d& covariance) {
  const double lever_m = kGraph.solver.lever_m;
  return covariance(0, 0) + covariance(1, 1) + lever_m * lever_m * covariance(2, 2);
}

/// Returns the covariance, in the frame of the map, that a constraint gives to a node at `point` beyond it. An error of
/// the constraint shifts all nodes beyond it, and turns them about its node `b`.
Eigen::Matrix3d effect(const PoseConstraint& constraint, const std::vector<Pose2>& map_from_node, const Point2& point) {
  const Pose2& from = map_from_node[constraint.a];
  const Point2 arm = point - map_from_node[constraint.b].translation();
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Identity();
  jacobian.col(0).head<2>() = rotate({1.0, 0.0}, from.theta_rad);
  jacobian.col(1).head<2>() = rotate({0.0, 1.0}, from.theta_rad);
  jacobian.col(2).head<2>() = Point2(-arm.y(), arm.x());
  return jacobian * constraint.covariance * jacobian.transpose();
}

}  // namespace

RelativeCovariance::RelativeCovariance(const std::vector<Pose2>& map_from_node,
                                       const std::vector<PoseConstraint>& constraints)
    : map_from_node_(map_from_node), constraints_(constraints), edges_(map_from_node.size()) {
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    const PoseConstraint& constraint = constraints[c];
    if (constraint.a >= edges_.size() || constraint.b >= edges_.size()) {
      throw std::invalid_argument("a constraint joins nodes that do not exist");
    }
    const double length = length_of(constraint.covariance);
    edges_[constraint.a].push_back({constraint.b, c, length});
    edges_[constraint.b].push_back({constraint.a, c, length});
  }
}

std::vector<std::size_t> RelativeCovariance::arrivals(std::size_t a, std::size_t b) const {
  std::vector<std::size_t> arrival(edges_.size(), kNone);
  std::vector<double> distance(edges_.size(), kInfinity);
  using Reached = std::pair<double, std::size_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  distance[a] = 0.0;
  open.push({0.0, a});
  while (!open.empty()) {
    const auto [so_far, node] = open.top();
    open.pop();
    if (node == b) break;
    if (so_far > distance[node]) continue;
    for (const Edge& edge : edges_[node]) {
      const double there = so_far + edge.length;
      if (there >= distance[edge.to]) continue;
      distance[edge.to] = there;
      arrival[edge.to] = edge.constraint;
      open.push({there, edge.to});
    }
  }
  return arrival;
}

Eigen::Matrix3d RelativeCovariance::between(std::size_t a, std::size_t b) const {
  const std::vector<std::size_t> arrival = arrivals(a, b);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t node = b; node != a;) {
    if (arrival[node] == kNone) return Eigen::Matrix3d::Constant(kInfinity);
    const PoseConstraint& constraint = constraints_[arrival[node]];
    sum += effect(constraint, map_from_node_, map_from_node_[b].translation());
    node = constraint.a == node ? constraint.b : constraint.a;
  }
  Eigen::Matrix3d to_a = Eigen::Matrix3d::Identity();
  to_a.col(0).head<2>() = rotate({1.0, 0.0}, -map_from_node_[a].theta_rad);
  to_a.col(1).head<2>() = rotate({0.0, 1.0}, -map_from_node_[a].theta_rad);
  return to_a * sum * to_a.transpose();
}

}  // namespace shapemap
