// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "graph/keyframe_graph.hpp"
#include "optimized_map.hpp"
#include "shapemap/core/execution.hpp"

namespace shapemap {

/// Verifies the doubtful edges of `map` that alone, or only with weak loops, join the scans before them to those after
/// them, by all scans of both sides; see verify_edges(). Loops that the result contradicts are opened again. Cross-edge
/// matches give further candidates to the edges of `graph`. Returns whether anything changed. Components that are no
/// longer joined then lie far apart. `store`, whose keys are scans, may be null.
bool verify_doubtful_edges(const RobustOptions& options, const Execution& execution, MatchCache* store,
                           KeyframeGraph& graph, OptimizedMap& map);

}  // namespace shapemap
