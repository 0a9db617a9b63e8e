// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "graph/keyframe_graph.hpp"
#include "optimized_map.hpp"
#include "shapemap/core/execution.hpp"

namespace shapemap {

/// Where the sub-scans of keyframes are in their position, by keyframe; none: all at their nominal places.
using SweepCorrections = std::vector<std::vector<Pose2>>;

/// Refines the poses of `map` and of all sub-scans. Changes nothing where each position has one sub-scan.
SweepCorrections refine_sweeps_of_map(const KeyframeGraph& graph, const RobustOptions& options,
                                      const Execution& execution, OptimizedMap& map);

}  // namespace shapemap
