// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop_candidates.hpp"

#include <algorithm>
#include <optional>

#include "graph/keyframe_match_cache.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/matching/match_probability.hpp"

namespace shapemap {
namespace {

EdgeChoices choices_of_edge(const KeyframeGraph& chain, std::size_t i) {
  const OdometryEdge& link = chain.edges[i];
  EdgeChoices result;
  for (std::size_t rank = 0; rank < link.candidates.size(); ++rank) {
    const std::size_t k = ranked_candidate(link, rank);
    const PoseConstraint constraint = edge_constraint(chain, i, k);
    result.candidates.push_back({constraint.a_from_b, constraint.covariance, link.candidates[k].score});
  }
  if (result.exists()) result.probability = edge_probability(link);
  for (const MatchCandidate& pose : link.candidates) {
    result.any_probability = std::max(result.any_probability, match_probability(pose, kFullMargin));
  }
  return result;
}

}  // namespace

NodeViews views_of(const KeyframeGraph& chain) {
  NodeViews views;
  for (const Keyframe& keyframe : chain.keyframes) views.push_back(keyframe.view);
  return views;
}

std::size_t ranked_candidate(const OdometryEdge& link, std::size_t rank) {
  if (rank == 0) return link.choice.candidate;
  return rank <= link.choice.candidate ? rank - 1 : rank;
}

std::vector<EdgeChoices> edge_choices(const KeyframeGraph& chain) {
  std::vector<EdgeChoices> edges;
  for (std::size_t i = 0; i < chain.edges.size(); ++i) edges.push_back(choices_of_edge(chain, i));
  return edges;
}

void find_loops(const KeyframeGraph& chain, std::size_t end, const LoopSearch& by_position, LoopCandidates& known) {
  std::optional<KeyframeMatchCache> keyframe_store;
  if (by_position.store) keyframe_store.emplace(chain, *by_position.store);
  LoopSearch search = by_position;
  search.store = keyframe_store ? &*keyframe_store : nullptr;
  RunObserver& observer = search.execution.observer;
  const NodeViews views = views_of(chain);
  const auto add = [&](const std::vector<LoopCandidate>& found) {
    known.candidates.insert(known.candidates.end(), found.begin(), found.end());
  };

  observer.on_stage("loops");
  const NodeViews compared(views.begin(), views.begin() + static_cast<std::ptrdiff_t>(end));
  add(likely_loops(compared, known.num_searched, search));
  known.num_searched = end;

  observer.on_stage("doubts");
  const std::size_t end_of_links = std::min(end, chain.edges.size());
  std::vector<std::size_t> doubtful;
  for (std::size_t i = known.num_bridged; i < end_of_links; ++i) {
    const OdometryEdge& link = chain.edges[i];
    if (link.candidates.empty()) continue;
    if (edge_probability(link) < search.detection.bridge_below) doubtful.push_back(i);
  }
  known.num_bridged = end_of_links;
  try {
    add(cross_edge_matches(views, doubtful, search));
  } catch (const Interrupted&) {  // what was read is made one map without
  }
}

}  // namespace shapemap
