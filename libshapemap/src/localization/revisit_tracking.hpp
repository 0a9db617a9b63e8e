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

/// Follows the chain from the end of a settled map on, and knows places again that have a keyframe: where the robot is
/// sure to be in the map, no more needs to be solved for that.
class RevisitTracker {
 public:
  explicit RevisitTracker(const RobustOptions& options) : options_(options) {}

  /// `map` is solved for all keyframes of the chain; those after the first `num_settled` may still change.
  void start(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t num_settled);

  /// All of the chain, with what `redundant` knows again in its place. Those keyframes are still to be retired, and the
  /// map that is left then to be given to renew().
  struct Followed {
    OptimizedMap map;
    std::vector<std::optional<ReplacementKeyframe>> redundant;  ///< per keyframe: of those that may go
    std::size_t num_followed = 0;  ///< the keyframes after the first so many may still change
  };
  Followed follow(const KeyframeGraph& graph, const std::vector<EdgeCandidate>& loops);

  /// Whether loops help: the robot does not know where it is in the map.
  bool is_lost() const { return state_.is_lost; }

  /// Without the keyframes that were retired; the last `num_open` may still change.
  void renew(OptimizedMap map, std::size_t num_open);

 private:
  const RobustOptions& options_;
  OptimizedMap settled_;
  std::size_t active_scan_ = 0;  ///< of the first keyframe of the part of the map that the robot was sure to be in
  LocalizationState state_;
};

}  // namespace shapemap
