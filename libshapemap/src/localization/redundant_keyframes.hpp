// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "inference/optimized_map.hpp"
#include "shapemap/inference/robust_options.hpp"

/// A place that is visited again needs no more keyframes than it has, so that their number grows with the area and not
/// with the length of the path.
namespace shapemap {

/// An earlier keyframe that can replace another.
struct ReplacementKeyframe {
  std::size_t keyframe = 0;
  MatchCandidate pose;  ///< the pose of the replaced keyframe in the frame of the earlier one
};

/// A keyframe, and the earlier ones that may replace it.
struct ReplacementQuery {
  std::size_t keyframe;
  const std::vector<std::size_t>& earlier;
  std::size_t most;  ///< the search ends when so many are found
};

/// Returns those of `query.earlier`, in their order, that show the same as the keyframe at the poses of the map.
std::vector<ReplacementKeyframe> replacements_for(const KeyframeGraph& graph,
                                                  const std::vector<Pose2>& map_from_keyframe,
                                                  const ReplacementQuery& query, const RobustOptions& options);

/// Returns for each keyframe whether it may be culled when another can replace it. The last few keyframes, those at
/// doubtful edges, and those with several sweeps must stay.
std::vector<bool> cullable_keyframes(const KeyframeGraph& graph, const OptimizedMap& map);

/// The comparison of the keyframes of a map with earlier ones at the same place.
struct RedundantKeyframes {
  std::vector<std::optional<ReplacementKeyframe>> of_keyframe;  ///< the replacement of each that may be culled
  std::vector<bool> is_in_doubt;  ///< whether a keyframe nearby shows something else than an earlier one at its place
  std::size_t num_again = 0;      ///< number of keyframes at a place where the robot had been long before
  std::size_t num_known = 0;      ///< number of those that show the same as an earlier one

  /// Returns whether so large a share is known as in a right map: nearly all are there, while a fourth is not where
  /// rows of similar rooms are wrongly laid on each other.
  bool are_of_right_map() const;
};
/// Compares all keyframes with the earlier ones at their places.
RedundantKeyframes find_redundant_keyframes(const KeyframeGraph& graph, const OptimizedMap& map,
                                            const RobustOptions& options, int threads);

}  // namespace shapemap
