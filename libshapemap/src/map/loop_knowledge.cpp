// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop_knowledge.hpp"

#include <algorithm>
#include <optional>

#include "keyframe_store.hpp"
#include "shapemap/align/confidence.hpp"
#include "shapemap/core/errors.hpp"

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

void find_loops(const KeyframeChain& chain, std::size_t end, const MappingOptions& options, RunObserver& observer,
                AlignmentStore* store, LoopKnowledge& known) {
  std::optional<KeyframeStore> keyframe_store;
  if (store) keyframe_store.emplace(chain, *store);
  AlignmentStore* const of_keyframes = keyframe_store ? &*keyframe_store : nullptr;
  const HypothesisSearchOptions& search = options.robust.search;
  const NodeViews views = views_of(chain);
  const auto add = [&](const std::vector<LoopHypothesis>& found) {
    known.hypotheses.insert(known.hypotheses.end(), found.begin(), found.end());
  };

  observer.on_stage("loops");
  const NodeViews compared(views.begin(), views.begin() + static_cast<std::ptrdiff_t>(end));
  add(likely_loops(compared, known.num_searched, search, options.loop_search, options.chain.threads, observer,
                   of_keyframes));
  known.num_searched = end;

  observer.on_stage("doubts");
  const std::size_t end_of_links = std::min(end, chain.links.size());
  std::vector<std::size_t> doubtful;
  for (std::size_t i = known.num_bridged; i < end_of_links; ++i) {
    const KeyframeLink& link = chain.links[i];
    if (link.hypotheses.empty()) continue;
    if (link_probability(link) < options.loop_search.bridge_below) doubtful.push_back(i);
  }
  known.num_bridged = end_of_links;
  try {
    add(bridges(views, doubtful, search, options.chain.threads, observer, of_keyframes));
  } catch (const Interrupted&) {  // what was read is made one map without
  }
}

}  // namespace shapemap
