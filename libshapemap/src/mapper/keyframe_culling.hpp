// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "localization/redundant_keyframes.hpp"
#include "loops/loop_candidates.hpp"
#include "shapemap/mapper/mapper_options.hpp"

namespace shapemap {

/// Takes the keyframes that others can stand for out of the chain. Their scans are attached to those, the links around
/// them become what `map` says, and so do the loops in `known`. `map` loses them as well.
void cull_keyframes(const std::vector<std::optional<ReplacementKeyframe>>& redundant, const MappingOptions& options,
                    OptimizedMap& map, KeyframeGraph& graph, LoopCandidates& known);

}  // namespace shapemap
