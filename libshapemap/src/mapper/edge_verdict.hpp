// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <cstddef>

#include "graph/keyframe_graph.hpp"
#include "inference/optimized_map.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapping_events.hpp"

namespace shapemap {

/// Fills in `outcome`, the result of the second keyframe of edge number `edge`, by the candidate of that edge in the
/// map. Returns the chosen candidate; nothing where the edge has none, or joins two sessions.
std::optional<EdgeChosen> judge_edge(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t edge,
                                     const ConfidenceOptions& options, ScanResult& outcome);

}  // namespace shapemap
