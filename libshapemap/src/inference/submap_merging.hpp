// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/observer.hpp"
#include "shapemap/inference/map_score.hpp"
#include "shapemap/inference/map_search.hpp"
#include "shapemap/loops/loop_clusters.hpp"

namespace shapemap {

/// The evidence about the relative poses of nodes before submaps are merged.
struct SubmapEvidence {
  const std::vector<Edge>& edges;  ///< edge i joins node i to node i + 1
  const std::vector<EdgeCandidate>& loops;
  const std::vector<Pose2>& map_of_odometry;  ///< poses of the nodes by the first candidates of the edges
};

/// Returns a first map by merging submaps, two at a time. The first submaps are the stretches whose edges are all sure.
/// Each time, the two submaps are merged whose best relative pose leads most over the next best. A relative pose gains
/// by the candidates that agree on it, and loses by crossed views and by steps that are too long. So a doubtful edge is
/// decided late, when the submaps on both sides are large and tell most. Submaps that remain, also when the observer
/// asks to stop, keep the relative poses of the odometry, and so do different logs, which no odometry edge joins.
///
/// `variant` 0 uses the gains as they are. Each other variant disturbs them in its own fixed manner, because an early
/// mistake spoils the rest.
std::vector<Pose2> merged_submaps(const SubmapEvidence& evidence, MapScore& score, const MapSearchOptions& options,
                                  int variant, RunObserver& observer);

}  // namespace shapemap
