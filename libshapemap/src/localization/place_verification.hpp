// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "inference/optimized_map.hpp"
#include "redundant_keyframes.hpp"
#include "shapemap/inference/robust_options.hpp"

namespace shapemap {

/// The evidence of the map for the pose of a keyframe.
struct PlaceEvidence {
  std::optional<ReplacementKeyframe> replacement;  ///< a keyframe of the map that shows the same, if there is one
  double log_odds = 0.0;  ///< evidence for the pose: above 0 with a replacement, below 0 where the map shows
                          ///< something else, and 0 where the map has no keyframes
};

/// A stretch of successive keyframes at a place of the map. The evidence may fall so low that the rest is left out.
struct PlacedStretch {
  double log_odds = 0.0;                 ///< evidence for the place, summed over the keyframes
  std::vector<Pose2> map_from_keyframe;  ///< poses; those of keyframes that are left out are far away
  std::vector<std::optional<ReplacementKeyframe>> redundant;  ///< the replacement of each keyframe, if there is one
  std::size_t sure_begin = 0;                                 ///< the first of its keyframes whose pose is sure
  std::size_t sure_end = 0;                                   ///< the end of those whose pose is sure
};

/// Compares keyframes with the keyframes of the active component of a map.
class PlaceVerification {
 public:
  PlaceVerification(const KeyframeGraph& graph, const RobustOptions& options, std::size_t active_component)
      : graph_(graph),
        options_(options),
        active_component_(active_component),
        is_excluded_(graph.keyframes.size(), false) {}

  /// Compares keyframe `b`, at its pose in `map`, with the keyframes before `end`.
  PlaceEvidence look(const OptimizedMap& map, std::size_t b, std::size_t end) const;

  /// Places keyframes `first` to before `last`, from `seed` on in both directions: each by the edge to the one before,
  /// and then by its replacement among the keyframes before `first`. Their poses in `map` are overwritten.
  PlacedStretch lay(OptimizedMap& map, std::size_t first, std::size_t last, std::size_t seed,
                    const Pose2& map_from_seed) const;

  /// Excludes keyframe `b`, which another replaces, from the keyframes that can replace others.
  void exclude(std::size_t b) { is_excluded_[b] = true; }
  void include(std::size_t b) { is_excluded_[b] = false; }

  std::size_t active_component() const { return active_component_; }

 private:
  std::vector<std::size_t> at_place(const OptimizedMap& map, std::size_t b, std::size_t end) const;

  const KeyframeGraph& graph_;
  const RobustOptions& options_;
  std::size_t active_component_;
  std::vector<bool> is_excluded_;
};

/// Returns the relative pose of the candidate that `map` takes of the edge to keyframe `b`, which must not be cut.
const Pose2& edge_in_map(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t b);

/// Returns the pose of a keyframe by the one that replaces it.
Pose2 pose_by(const OptimizedMap& map, const ReplacementKeyframe& replacement);

}  // namespace shapemap
