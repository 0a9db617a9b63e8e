// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/observer.hpp"
#include "shapemap/inference/map_score.hpp"
#include "shapemap/inference/map_search.hpp"
#include "shapemap/loops/loop_clusters.hpp"

namespace shapemap {

/// What is known of how nodes lie to each other before submaps are merged.
struct SubmapEvidence {
  const std::vector<Edge>& edges;  ///< edge i joins node i to node i + 1
  const std::vector<EdgeCandidate>& loops;
  const std::vector<Pose2>& map_of_odometry;  ///< poses of the nodes by the first candidates of the edges
};

/// A first map, made of pieces: stretches of the chain whose alignments are all sure are laid together, two at a time.
/// Next come those for which one way (alignments of their scans, less what tells against it: views that are crossed,
/// steps that are too long) leads most over all others. So a doubtful alignment is decided late, when the pieces on
/// both sides are large and tell most. Pieces that the chain does not join are not laid together.
///
/// `variant` 0 is that; others disturb what ways gain, each differently and always in the same way, for a wrong
/// decision early on spoils the rest. Stops early when the observer asks to; the rest then stays as the chain has it.
std::vector<Pose2> merged_submaps(const SubmapEvidence& evidence, MapScore& score, const MapSearchOptions& options,
                                  int variant, RunObserver& observer);

}  // namespace shapemap
