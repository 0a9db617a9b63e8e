// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "shapemap/inference/robust_options.hpp"

namespace shapemap {

/// Learns the motion prior of the sensor from the sure edges of the graph, and completes the edges that are not
/// complete yet: candidates score less the less likely their motion is, and edges that are then in doubt are searched
/// again. Edges whose motion was followed from scan to scan keep their scores, because that prediction is more precise.
/// Returns the completed edges, in order. OdometryEdge::choice must be up to date, and is out of date afterwards.
std::vector<std::size_t> rescore_by_motion(const RobustOptions& options, int threads, KeyframeGraph& graph);

}  // namespace shapemap
