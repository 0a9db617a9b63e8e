// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "graph/keyframe_graph.hpp"
#include "optimized_map.hpp"
#include "shapemap/core/execution.hpp"

namespace shapemap {

/// Revises the doubtful links of `map` that join what is before them to what comes after, alone or with weak loops, by
/// all scans of both; see verify_edges(). Loops that then are contradicted are opened again. What bridges over a link
/// say of it is added to its hypotheses in `chain`. Whether anything changed: poses of pieces that are not joined any
/// more then lie far apart. `store`, by positions, may be null.
bool verify_doubtful_edges(const RobustOptions& options, const Execution& execution, MatchCache* store,
                           KeyframeGraph& graph, OptimizedMap& map);

}  // namespace shapemap
