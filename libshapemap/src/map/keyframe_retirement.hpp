// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "keyframe_chain.hpp"
#include "keyframe_map.hpp"
#include "loop_knowledge.hpp"
#include "shapemap/map/mapping_options.hpp"
#include "shapemap/scan/scan.hpp"

/// Where a place is visited again, the keyframes that it has are enough: so there are as many as the area needs, and
/// not as the way was long.
namespace shapemap {

/// The last few keyframes are always kept: those to come are compared to them.
inline constexpr std::size_t kKeyframesInUse = 16;

/// An earlier keyframe that can stand for another.
struct StandIn {
  std::size_t keyframe = 0;
  PoseHypothesis pose;  ///< of the other, in its frame
};

/// Per keyframe: which one can stand for it, where one can. A keyframe in doubt stays, and one with several sub-scans.
std::vector<std::optional<StandIn>> find_stand_ins(const Log& log, const KeyframeChain& chain, const KeyframeMap& map,
                                                   const MappingOptions& options);

/// Takes those keyframes out of the chain. Their scans are attached to those that stand for them, the links around them
/// become what `map` says, and so do the loops in `known`.
void retire_keyframes(const std::vector<std::optional<StandIn>>& stand_ins, const KeyframeMap& map,
                      const MappingOptions& options, KeyframeChain& chain, LoopKnowledge& known);

}  // namespace shapemap
