// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/loops/loop_clusters.hpp"

namespace shapemap {

/// A cluster that says of some of the same nodes that they are elsewhere, and how strongly, by these nodes alone.
struct ConflictingLoop {
  std::size_t cluster = 0;
  double strength = 0.0;
};

/// For each cluster, all others that share nodes with one of its two stretches. Whether they contradict it depends on
/// the map: two earlier visits to one place are no rivals.
std::vector<std::vector<ConflictingLoop>> conflicting_loops(const std::vector<LoopCluster>& clusters);

}  // namespace shapemap
