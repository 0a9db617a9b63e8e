// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "graph/keyframe_graph.hpp"
#include "optimized_map.hpp"
#include "shapemap/core/execution.hpp"

namespace shapemap {

/// The corrections of the sweeps of each keyframe, in its frame. If empty, all sweeps are at their nominal poses.
using SweepCorrections = std::vector<std::vector<Pose2>>;

/// Refines the poses of `map` and of all sweeps. It changes nothing where each scan has one sweep.
SweepCorrections refine_sweeps_of_map(const KeyframeGraph& graph, const RobustOptions& options,
                                      const Execution& execution, OptimizedMap& map);

}  // namespace shapemap
