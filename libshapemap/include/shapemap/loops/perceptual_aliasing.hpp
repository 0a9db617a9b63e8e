// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/graph/edge.hpp"
#include "shapemap/loops/loop_clusters.hpp"

/// Places that look like others.
namespace shapemap {

/// `hypotheses` as far as they tell more than that places look alike here. Where two scans a short way apart seem to be
/// of one place, though the chain is sure that they are not, that one is left out, and what else is known of these
/// nodes and their neighbours loses its odds: other places may look like that as well.
///
/// Edges that are at least `sure_probability` probable are not questioned. `map_of_odometry`: poses of the nodes by the
/// first alternative of each link. Throws std::invalid_argument unless it has more nodes than links.
std::vector<EdgeCandidate> without_aliases(const std::vector<EdgeCandidate>& candidates, const std::vector<Edge>& edges,
                                           const std::vector<Pose2>& map_of_odometry, double sure_probability);

}  // namespace shapemap
