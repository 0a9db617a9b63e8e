// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "shapemap/graph/edge.hpp"
#include "shapemap/loops/loop_detection.hpp"
#include "shapemap/matching/match_cache.hpp"

namespace shapemap {

/// What has been found out about which keyframes see the same.
struct LoopCandidates {
  std::vector<EdgeCandidate> candidates;
  std::size_t num_searched = 0;  ///< the first so many keyframes have been compared to those before them
  std::size_t num_bridged = 0;   ///< and of the first so many links the doubtful ones have been bridged
};

NodeViews views_of(const KeyframeGraph& graph);
std::vector<Edge> edge_choices(const KeyframeGraph& graph);

/// Index of hypothesis number `rank` of a link, when that which the chain chose comes first, as in Edge.
std::size_t ranked_candidate(const OdometryEdge& edge, std::size_t rank);

/// Adds what there is to know of the first `end` keyframes; nothing is done twice. The store of `search` is by
/// positions. Stops with what was found by then when the observer asks to.
void find_loops(const KeyframeGraph& graph, std::size_t end, const LoopSearch& search, LoopCandidates& known);

}  // namespace shapemap
