// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop_candidates.hpp"

#include <algorithm>
#include <optional>

#include "graph/keyframe_match_cache.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/matching/match_probability.hpp"

namespace shapemap {
namespace {

ChainLink chain_link(const KeyframeChain& chain, std::size_t i) {
  const KeyframeLink& link = chain.links[i];
  ChainLink result;
  for (std::size_t rank = 0; rank < link.hypotheses.size(); ++rank) {
    const std::size_t k = ranked_hypothesis(link, rank);
    const PoseConstraint constraint = link_constraint(chain, i, k);
    result.alternatives.push_back({constraint.a_from_b, constraint.covariance, link.hypotheses[k].score});
  }
  if (result.exists()) result.probability = link_probability(link);
  for (const PoseHypothesis& pose : link.hypotheses) {
    result.any_probability = std::max(result.any_probability, match_probability(pose, kFullMargin));
  }
  return result;
}

}  // namespace

NodeViews views_of(const KeyframeChain& chain) {
  NodeViews views;
  for (const Keyframe& keyframe : chain.keyframes) views.push_back(keyframe.view);
  return views;
}

std::size_t ranked_hypothesis(const KeyframeLink& link, std::size_t rank) {
  if (rank == 0) return link.choice.alternative;
  return rank <= link.choice.alternative ? rank - 1 : rank;
}

std::vector<ChainLink> chain_links(const KeyframeChain& chain) {
  std::vector<ChainLink> links;
  for (std::size_t i = 0; i < chain.links.size(); ++i) links.push_back(chain_link(chain, i));
  return links;
}

void find_loops(const KeyframeChain& chain, std::size_t end, const LoopSearch& by_position, LoopKnowledge& known) {
  std::optional<KeyframeStore> keyframe_store;
  if (by_position.store) keyframe_store.emplace(chain, *by_position.store);
  LoopSearch search = by_position;
  search.store = keyframe_store ? &*keyframe_store : nullptr;
  RunObserver& observer = search.execution.observer;
  const NodeViews views = views_of(chain);
  const auto add = [&](const std::vector<LoopHypothesis>& found) {
    known.hypotheses.insert(known.hypotheses.end(), found.begin(), found.end());
  };

  observer.on_stage("loops");
  const NodeViews compared(views.begin(), views.begin() + static_cast<std::ptrdiff_t>(end));
  add(likely_loops(compared, known.num_searched, search));
  known.num_searched = end;

  observer.on_stage("doubts");
  const std::size_t end_of_links = std::min(end, chain.links.size());
  std::vector<std::size_t> doubtful;
  for (std::size_t i = known.num_bridged; i < end_of_links; ++i) {
    const KeyframeLink& link = chain.links[i];
    if (link.hypotheses.empty()) continue;
    if (link_probability(link) < search.detection.bridge_below) doubtful.push_back(i);
  }
  known.num_bridged = end_of_links;
  try {
    add(bridges(views, doubtful, search));
  } catch (const Interrupted&) {  // what was read is made one map without
  }
}

}  // namespace shapemap
