// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "shapemap/inference/robust_options.hpp"

namespace shapemap {

/// Sets OdometryEdge::transition_scores of edges `first`, each an index of an edge that another follows: how well the
/// first and the last of their three scans go together, for each candidate of the one edge and each of the next, as a
/// weighted logarithm of odds.
void set_three_scan_scores(const std::vector<std::size_t>& first, const RobustOptions& options, int threads,
                           KeyframeGraph& graph);

/// The same for all edges that have no scores yet.
void add_three_scan_scores(const RobustOptions& options, int threads, KeyframeGraph& graph);

}  // namespace shapemap
