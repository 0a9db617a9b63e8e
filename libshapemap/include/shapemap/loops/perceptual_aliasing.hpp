// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/graph/edge.hpp"
#include "shapemap/loops/loop_clusters.hpp"

/// Perceptual aliasing is that different places look the same.
namespace shapemap {

/// Returns the loop candidates that are more than perceptual aliasing. A candidate between two nodes a short way apart
/// is left out if the sure odometry edges between them contradict it. All other candidates of these nodes and their
/// neighbours then lose its log odds, because more distant places may look the same as well.
///
/// Edges that are at least `sure_probability` probable are taken as certain. `map_of_odometry` has the poses of the
/// nodes by the first candidate of each edge. Throws std::invalid_argument unless it has more nodes than `edges`.
std::vector<EdgeCandidate> without_aliases(const std::vector<EdgeCandidate>& candidates, const std::vector<Edge>& edges,
                                           const std::vector<Pose2>& map_of_odometry, double sure_probability);

}  // namespace shapemap
