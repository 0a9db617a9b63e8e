// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "graph/keyframe_graph.hpp"
#include "inference/optimized_map.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/trace_sink.hpp"

namespace shapemap {

/// Fills in what the alignment of a keyframe to the one before it, by link number `link`, says now that the map has.
/// `sink` may be null.
void judge_edge(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t edge, const ConfidenceOptions& options,
                TraceSink* sink, ScanResult& outcome);

}  // namespace shapemap
