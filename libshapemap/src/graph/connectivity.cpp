// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "shapemap/graph/pose_graph.hpp"

namespace shapemap {
namespace {

void check(std::size_t num_nodes, const PoseConstraint& constraint) {
  if (constraint.a >= num_nodes || constraint.b >= num_nodes || constraint.a == constraint.b) {
    throw std::invalid_argument("a constraint joins nodes that do not exist, or one with itself");
  }
}

/// Finds the bridges of a graph (Tarjan 1974) without recursion, which would be as deep as the graph is long.
class BridgeSearch {
 public:
  BridgeSearch(std::size_t num_nodes, const std::vector<PoseConstraint>& constraints)
      : constraints_(constraints), at_(num_nodes), entered_(num_nodes, 0), lowest_(num_nodes, 0) {
    for (std::size_t c = 0; c < constraints.size(); ++c) {
      at_[constraints[c].a].push_back(c);
      at_[constraints[c].b].push_back(c);
    }
  }

  std::vector<bool> run() {
    std::vector<bool> is_bridge(constraints_.size(), false);
    for (std::size_t node = 0; node < at_.size(); ++node) {
      if (entered_[node] == 0) explore(node, is_bridge);
    }
    return is_bridge;
  }

 private:
  struct Step {
    std::size_t node;
    std::size_t by;  ///< the constraint that led here; kNone for the first node
    std::size_t next = 0;
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  void explore(std::size_t first, std::vector<bool>& is_bridge) {
    std::vector<Step> path{{first, kNone}};
    entered_[first] = lowest_[first] = ++time_;
    while (!path.empty()) {
      Step& step = path.back();
      if (step.next < at_[step.node].size()) {
        const std::size_t c = at_[step.node][step.next++];
        if (c == step.by) continue;
        const std::size_t other = constraints_[c].a == step.node ? constraints_[c].b : constraints_[c].a;
        if (entered_[other] == 0) {
          entered_[other] = lowest_[other] = ++time_;
          path.push_back({other, c});
        } else {
          lowest_[step.node] = std::min(lowest_[step.node], entered_[other]);
        }
        continue;
      }
      const Step done = step;
      path.pop_back();
      if (path.empty()) break;
      const std::size_t parent = path.back().node;
      lowest_[parent] = std::min(lowest_[parent], lowest_[done.node]);
      if (lowest_[done.node] > entered_[parent]) is_bridge[done.by] = true;
    }
  }

  const std::vector<PoseConstraint>& constraints_;
  std::vector<std::vector<std::size_t>> at_;  ///< indices of the constraints of each node
  std::vector<std::size_t> entered_;
  std::vector<std::size_t> lowest_;
  std::size_t time_ = 0;
};

}  // namespace

std::vector<std::size_t> connected_components(std::size_t num_nodes, const std::vector<PoseConstraint>& constraints) {
  std::vector<std::size_t> part(num_nodes);
  std::iota(part.begin(), part.end(), std::size_t{0});
  const auto root = [&](std::size_t node) {
    while (part[node] != node) node = part[node] = part[part[node]];
    return node;
  };
  for (const PoseConstraint& constraint : constraints) {
    check(num_nodes, constraint);
    const std::size_t a = root(constraint.a);
    const std::size_t b = root(constraint.b);
    part[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t node = 0; node < num_nodes; ++node) part[node] = root(node);
  return part;
}

std::vector<bool> bridge_edges(std::size_t num_nodes, const std::vector<PoseConstraint>& constraints) {
  for (const PoseConstraint& constraint : constraints) check(num_nodes, constraint);
  return BridgeSearch(num_nodes, constraints).run();
}

}  // namespace shapemap
