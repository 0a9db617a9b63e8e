// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "keyframe_chain.hpp"
#include "keyframe_map.hpp"

namespace shapemap {

/// Where the sub-scans of keyframes are in their position, by keyframe; none: all at their nominal places.
using SubScanCorrections = std::vector<std::vector<Pose2>>;

/// Refines the poses of `map` and of all sub-scans. Changes nothing where each position has one sub-scan.
SubScanCorrections refine_sub_scans_of_map(const Log& log, const KeyframeChain& chain, const MappingOptions& options,
                                           RunObserver& observer, KeyframeMap& map);

}  // namespace shapemap
