// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "keyframe_chain.hpp"
#include "keyframe_map.hpp"
#include "shapemap/map/trace_sink.hpp"
#include "shapemap/map/trajectory.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// Fills in what the alignment of a keyframe to the one before it, by link number `link`, says now that the map has.
/// `sink` may be null.
void judge_link(const Log& log, const KeyframeChain& chain, const KeyframeMap& map, std::size_t link,
                const ConfidenceOptions& options, TraceSink* sink, PositionResult& outcome);

}  // namespace shapemap
