// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "inference/optimized_map.hpp"
#include "shapemap/inference/robust_options.hpp"

/// Where a place is visited again, the keyframes that it has are enough: so there are as many as the area needs, and
/// not as the way was long.
namespace shapemap {

/// An earlier keyframe that can stand for another.
struct ReplacementKeyframe {
  std::size_t keyframe = 0;
  MatchCandidate pose;  ///< of the other, in its frame
};

/// Those of `earlier`, in their order, that can stand for keyframe `b` where the map has the two; at most `most`.
std::vector<ReplacementKeyframe> replacements_for(const KeyframeGraph& graph,
                                                  const std::vector<Pose2>& map_from_keyframe, std::size_t b,
                                                  const std::vector<std::size_t>& earlier, std::size_t most,
                                                  const RobustOptions& options);

/// Per keyframe: whether it may go when another can stand for it. Those at doubtful links stay, those with several
/// sub-scans, and the last few.
std::vector<bool> settled_keyframes(const KeyframeGraph& graph, const OptimizedMap& map);

/// What a map says of each of its keyframes at the place of others.
struct RedundantKeyframes {
  std::vector<std::optional<ReplacementKeyframe>> of_keyframe;  ///< which one can stand for it, where it may go
  std::vector<bool> is_in_doubt;  ///< near one that shows something else than its place did before
  std::size_t num_again = 0;      ///< keyframes at a place where the robot had been long before
  std::size_t num_known = 0;      ///< those of them that show the same as it did then

  /// Of a map that is right, nearly all do; where rows of like rooms are laid on each other, a fourth does not.
  bool are_of_right_map() const;
};
RedundantKeyframes find_redundant_keyframes(const KeyframeGraph& graph, const OptimizedMap& map,
                                            const RobustOptions& options, int threads);

}  // namespace shapemap
