// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/graph/odometry_edge.hpp"
#include "graph/keyframe_graph.hpp"
#include "shapemap/loops/loop_detection.hpp"
#include "shapemap/matching/match_cache.hpp"

namespace shapemap {

/// What has been found out about which keyframes see the same.
struct LoopKnowledge {
  std::vector<LoopHypothesis> hypotheses;
  std::size_t num_searched = 0;  ///< the first so many keyframes have been compared to those before them
  std::size_t num_bridged = 0;   ///< and of the first so many links the doubtful ones have been bridged
};

NodeViews views_of(const KeyframeChain& chain);
std::vector<ChainLink> chain_links(const KeyframeChain& chain);

/// Index of hypothesis number `rank` of a link, when that which the chain chose comes first, as in ChainLink.
std::size_t ranked_hypothesis(const KeyframeLink& link, std::size_t rank);

/// Adds what there is to know of the first `end` keyframes; nothing is done twice. The store of `search` is by
/// positions. Stops with what was found by then when the observer asks to.
void find_loops(const KeyframeChain& chain, std::size_t end, const LoopSearch& search, LoopKnowledge& known);

}  // namespace shapemap
