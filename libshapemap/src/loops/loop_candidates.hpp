// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "shapemap/graph/edge.hpp"
#include "shapemap/loops/loop_detection.hpp"
#include "shapemap/matching/match_cache.hpp"

namespace shapemap {

/// The loop candidates found so far, and how far the search has come.
struct LoopCandidates {
  std::vector<EdgeCandidate> candidates;
  std::size_t num_searched = 0;  ///< number of keyframes that have been matched to earlier ones
  std::size_t num_bridged = 0;   ///< number of edges that have cross-edge matches if they are doubtful
};

NodeViews views_of(const KeyframeGraph& graph);

/// Returns the odometry edges, each with the chosen candidate first.
std::vector<Edge> edge_choices(const KeyframeGraph& graph);

/// Returns the index in `edge` of candidate number `rank` of edge_choices().
std::size_t ranked_candidate(const OdometryEdge& edge, std::size_t rank);

/// Adds the loop candidates and cross-edge matches of the first `end` keyframes that `known` does not have yet. The
/// keys of the cache in `search` have the indices of scans. When the observer asks to stop, it keeps those found by
/// then.
void find_loops(const KeyframeGraph& graph, std::size_t end, const LoopSearch& search, LoopCandidates& known);

}  // namespace shapemap
