// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop_candidates.hpp"

#include <algorithm>
#include <optional>

#include "graph/keyframe_match_cache.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/matching/match_probability.hpp"

namespace shapemap {
namespace {

Edge choices_of_edge(const KeyframeGraph& graph, std::size_t i) {
  const OdometryEdge& edge = graph.edges[i];
  Edge result = edge_to_next(i, edge.insufficient_view);
  for (std::size_t rank = 0; rank < edge.candidates.size(); ++rank) {
    const std::size_t k = ranked_candidate(edge, rank);
    const PoseConstraint constraint = edge_constraint(graph, i, k);
    result.candidates.push_back({i, i + 1, constraint.a_from_b, constraint.covariance, edge.candidates[k].score});
  }
  if (result.exists()) result.probability = edge_probability(edge);
  for (const MatchCandidate& pose : edge.candidates) {
    result.any_probability = std::max(result.any_probability, match_probability(pose, kFullMargin));
  }
  return result;
}

}  // namespace

NodeViews views_of(const KeyframeGraph& graph) {
  NodeViews views;
  for (const Keyframe& keyframe : graph.keyframes) views.push_back(keyframe.view);
  return views;
}

std::size_t ranked_candidate(const OdometryEdge& edge, std::size_t rank) {
  if (rank == 0) return edge.choice.candidate;
  return rank <= edge.choice.candidate ? rank - 1 : rank;
}

std::vector<Edge> edge_choices(const KeyframeGraph& graph) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) edges.push_back(choices_of_edge(graph, i));
  return edges;
}

void find_loops(const KeyframeGraph& graph, std::size_t end, const LoopSearch& by_scan, LoopCandidates& known) {
  std::optional<KeyframeMatchCache> keyframe_store;
  if (by_scan.store) keyframe_store.emplace(graph, *by_scan.store);
  LoopSearch search = by_scan;
  search.store = keyframe_store ? &*keyframe_store : nullptr;
  RunObserver& observer = search.execution.observer;
  const NodeViews views = views_of(graph);
  const auto add = [&](const std::vector<EdgeCandidate>& found) {
    known.candidates.insert(known.candidates.end(), found.begin(), found.end());
  };

  observer.on_stage("loops");
  const NodeViews compared(views.begin(), views.begin() + static_cast<std::ptrdiff_t>(end));
  add(likely_loops(compared, known.num_searched, search));
  known.num_searched = end;

  observer.on_stage("doubts");
  const std::size_t end_of_edges = std::min(end, graph.edges.size());
  std::vector<std::size_t> doubtful;
  for (std::size_t i = known.num_bridged; i < end_of_edges; ++i) {
    const OdometryEdge& edge = graph.edges[i];
    if (edge.candidates.empty()) continue;
    if (edge_probability(edge) < search.detection.bridge_below) doubtful.push_back(i);
  }
  known.num_bridged = end_of_edges;
  try {
    add(cross_edge_matches(views, doubtful, search));
  } catch (const Interrupted&) {  // The map is made without cross-edge matches.
  }
}

}  // namespace shapemap
