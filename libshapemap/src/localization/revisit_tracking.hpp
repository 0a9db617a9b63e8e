// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "inference/optimized_map.hpp"
#include "localizer.hpp"
#include "redundant_keyframes.hpp"
#include "shapemap/inference/robust_options.hpp"
#include "shapemap/loops/loop_clusters.hpp"

namespace shapemap {

/// Localizes new keyframes in an optimised map, and finds those that the map can replace. Where the robot is surely in
/// the map, this needs no optimisation of the whole graph.
class RevisitTracker {
 public:
  explicit RevisitTracker(const RobustOptions& options) : options_(options) {}

  /// Starts with `map`, which is optimised for all keyframes; those after the first `num_settled` may still change.
  void start(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t num_settled);

  /// The map of all keyframes. The caller must cull the redundant ones, and give the rest of the map to renew().
  struct Followed {
    OptimizedMap map;
    std::vector<std::optional<ReplacementKeyframe>> redundant;  ///< the replacement of each keyframe that may be culled
    std::size_t num_followed = 0;  ///< the keyframes after the first so many may still change
  };
  /// Localizes the keyframes that the map does not have. `loops` are used when the robot is lost.
  Followed follow(const KeyframeGraph& graph, const std::vector<EdgeCandidate>& loops);

  /// Returns whether the robot's place in the map is unknown, so that loop candidates would help.
  bool is_lost() const { return state_.is_lost; }

  /// Replaces the map by one without the culled keyframes; the last `num_open` may still change.
  void renew(OptimizedMap map, std::size_t num_open);

 private:
  const RobustOptions& options_;
  OptimizedMap settled_;
  std::size_t active_scan_ = 0;  ///< the scan of the first keyframe of the component that the robot was surely in
  LocalizationState state_;
};

}  // namespace shapemap
