// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/execution.hpp"
#include "graph/keyframe_graph.hpp"
#include "optimized_map.hpp"

namespace shapemap {

/// Where the sub-scans of keyframes are in their position, by keyframe; none: all at their nominal places.
using SubScanCorrections = std::vector<std::vector<Pose2>>;

/// Refines the poses of `map` and of all sub-scans. Changes nothing where each position has one sub-scan.
SubScanCorrections refine_sub_scans_of_map(const KeyframeChain& chain, const RobustOptions& options,
                                           const Execution& execution, KeyframeMap& map);

}  // namespace shapemap
