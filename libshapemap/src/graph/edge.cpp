// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/edge.hpp"
#include "graph_numbers.hpp"

namespace shapemap {

Edge edge_to_next(std::size_t a, double insufficient_view) {
  Edge edge;
  edge.a = a;
  edge.b = a + 1;
  edge.insufficient_view = insufficient_view;
  return edge;
}

std::vector<Pose2> sure_steps(const std::vector<Edge>& edges) {
  std::vector<Pose2> steps;
  for (const Edge& edge : edges) {
    if (edge.exists() && edge.probability > kGraph.steps.sure) steps.push_back(edge.candidates.front().a_from_b);
  }
  return steps;
}

}  // namespace shapemap
