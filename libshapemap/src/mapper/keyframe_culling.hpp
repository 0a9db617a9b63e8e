// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "localization/redundant_keyframes.hpp"
#include "loops/loop_candidates.hpp"
#include "shapemap/mapper/mapper_options.hpp"

namespace shapemap {

/// Removes the keyframes with a replacement from `graph`, `map` and the loop candidates `known`. Their scans are
/// attached to the replacements, and the edges and loop candidates that they had are replaced by the relative poses of
/// `map`.
void cull_keyframes(const std::vector<std::optional<ReplacementKeyframe>>& redundant, const MappingOptions& options,
                    OptimizedMap& map, KeyframeGraph& graph, LoopCandidates& known);

}  // namespace shapemap
