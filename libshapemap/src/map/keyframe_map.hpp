// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "keyframe_chain.hpp"

namespace shapemap {

/// Where the keyframes are, and what holds them there.
struct KeyframeMap {
  std::vector<Pose2> map_from_keyframe;
  std::vector<int> link_choice;        ///< per link: which of its hypotheses; kCut: none
  std::vector<bool> held_by_loops;     ///< per link: its two keyframes stay where they are without it
  std::vector<std::size_t> component;  ///< per keyframe: the first of those that it hangs together with
  std::vector<ClosedLoop> loops;       ///< of positions
};

/// The chain as it is: errors add up.
KeyframeMap map_of_chain(const KeyframeChain& chain, const MappingOptions& options);

/// The chain with its loops closed, and all scans aligned to all that see the same. When the observer asks to stop,
/// with the loops that are closed by then.
KeyframeMap map_with_loops(const KeyframeChain& chain, const MappingOptions& options, RunObserver& observer,
                           AlignmentStore* store);

}  // namespace shapemap
