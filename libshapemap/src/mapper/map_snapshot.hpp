// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "graph/keyframe_graph.hpp"
#include "inference/optimized_map.hpp"
#include "shapemap/mapper/map.hpp"
#include "shapemap/mapper/map_result.hpp"

namespace shapemap {

/// Returns the map of an optimised graph, without a version. `num_scans` were pushed so far.
Map map_snapshot(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t num_scans);

/// Returns the map of a result, without a version.
Map map_snapshot(const MapResult& result);

}  // namespace shapemap
