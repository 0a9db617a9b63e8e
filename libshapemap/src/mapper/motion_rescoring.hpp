// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "shapemap/inference/robust_options.hpp"

namespace shapemap {

/// Learns from the sure edges of the graph how the sensor usually moves. Of the edges that have not been looked at so
/// before, candidates that move it otherwise then score less, edges that are in doubt by that are searched again, and
/// all are marked complete. Edges of which the motion was followed from scan to scan keep their scores: more is known
/// of them than that. Returns the edges that were completed, in order. OdometryEdge::choice must be up to date, and is
/// out of date afterwards.
std::vector<std::size_t> rescore_by_motion(const RobustOptions& options, int threads, KeyframeGraph& graph);

}  // namespace shapemap
