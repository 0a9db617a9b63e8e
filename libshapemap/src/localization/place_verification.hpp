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

/// What the map says of a keyframe at a place.
struct PlaceEvidence {
  std::optional<ReplacementKeyframe> replacement;  ///< where it is known
  double log_odds = 0.0;  ///< that the place is right: above 0 where it is known, below 0 where something
                          ///< else was seen, and 0 where nobody has been
};

/// A stretch of the chain, laid at a place of the map.
struct PlacedStretch {
  double log_odds = 0.0;                 ///< that the place is right, of all its keyframes
  std::vector<Pose2> map_from_keyframe;  ///< far away those that were not looked at, as it was soon seen to be wrong
  std::vector<std::optional<ReplacementKeyframe>> redundant;
  std::size_t sure_begin = 0;  ///< it is as it was laid from this one of its keyframes,
  std::size_t sure_end = 0;    ///< up to before this one
};

/// Holds keyframes against the keyframes of a map, of which only the component `home` counts.
class PlaceVerification {
 public:
  PlaceVerification(const KeyframeGraph& graph, const RobustOptions& options, std::size_t active_component)
      : graph_(graph),
        options_(options),
        active_component_(active_component),
        is_gone_(graph.keyframes.size(), false) {}

  /// Keyframe `b`, where `map` has it, against those before `end`.
  PlaceEvidence look(const OptimizedMap& map, std::size_t b, std::size_t end) const;

  /// Keyframes `first` to before `last`, from `seed` on in both directions: each where the link to the one before puts
  /// it, and then where the map knows it; against those before `first`. What `map` has for them is overwritten.
  PlacedStretch lay(OptimizedMap& map, std::size_t first, std::size_t last, std::size_t seed,
                    const Pose2& map_from_seed) const;

  /// Another stands for keyframe `b`: it does not stand for others.
  void let_go(std::size_t b) { is_gone_[b] = true; }
  void keep(std::size_t b) { is_gone_[b] = false; }

  std::size_t active_component() const { return active_component_; }

 private:
  std::vector<std::size_t> at_place(const OptimizedMap& map, std::size_t b, std::size_t end) const;

  const KeyframeGraph& graph_;
  const RobustOptions& options_;
  std::size_t active_component_;
  std::vector<bool> is_gone_;
};

/// What link `b - 1` to `b` says where `map` takes one of its hypotheses.
const Pose2& edge_in_map(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t b);

/// Where a keyframe is by the one that stands for it.
Pose2 pose_by(const OptimizedMap& map, const ReplacementKeyframe& replacement);

}  // namespace shapemap
