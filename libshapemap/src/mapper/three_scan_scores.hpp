// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "shapemap/inference/robust_options.hpp"

namespace shapemap {

/// Sets OdometryEdge::transition_scores of the edges `first`, each of which another edge must follow. The score of a
/// candidate of the one edge and a candidate of the next is a weighted log odds that the first and the last of the
/// three scans are consistent.
void set_three_scan_scores(const std::vector<std::size_t>& first, const RobustOptions& options, int threads,
                           KeyframeGraph& graph);

/// Does the same for all edges that have no scores yet.
void add_three_scan_scores(const RobustOptions& options, int threads, KeyframeGraph& graph);

}  // namespace shapemap
