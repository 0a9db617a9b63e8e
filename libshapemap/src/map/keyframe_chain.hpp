// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "chain_smoothing.hpp"
#include "shapemap/align/alignment_store.hpp"
#include "shapemap/align/pose_hypothesis.hpp"
#include "shapemap/core/observer.hpp"
#include "shapemap/map/mapping_options.hpp"
#include "shapemap/map/trace_sink.hpp"
#include "shapemap/map/trajectory.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// A scan that others are aligned to.
struct Keyframe {
  std::size_t position_index = 0;
  std::shared_ptr<const ScanView> view;
  std::optional<Pose2> expected;  ///< in the frame of the keyframe before; see KeyframeTracker::expected()
};

/// A scan that a keyframe stands for: taken from nearly the same place.
struct AttachedScan {
  std::size_t position_index = 0;
  std::size_t keyframe = 0;
  PoseHypothesis pose;  ///< in the frame of the keyframe
};

/// What a keyframe may be to the one before it, and which of it the scans around choose.
struct KeyframeLink {
  std::vector<PoseHypothesis> hypotheses;  ///< none: another log starts here, or nothing fits
  Choice choice;
  std::size_t num_of_chain = 0;  ///< where the link was revised: the hypotheses before that, which come first
};

struct KeyframeChain {
  std::vector<Keyframe> keyframes;
  std::vector<AttachedScan> attached;  ///< in the order of the log
  std::vector<KeyframeLink> links;     ///< links[i] joins keyframe i to keyframe i + 1
};

/// Each scan against the keyframe before it, with several hypotheses, of which the scans further back decide. Adds an
/// entry for each position to `result`, without a place. Stops early, with what is whole, when the observer asks to.
KeyframeChain chain_keyframes(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink,
                              AlignmentStore* store, MapResult& result);

}  // namespace shapemap
