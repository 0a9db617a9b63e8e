// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/loops/loop_clusters.hpp"

namespace shapemap {

/// A cluster that may put nodes of another cluster at a different place, and its strength at the shared nodes alone.
struct ConflictingLoop {
  std::size_t cluster = 0;
  double strength = 0.0;
};

/// Returns for each cluster all others that share nodes with one of its two stretches. Whether these contradict it
/// depends on the map: loops to two earlier visits of one place are not in conflict.
std::vector<std::vector<ConflictingLoop>> conflicting_loops(const std::vector<LoopCluster>& clusters);

}  // namespace shapemap
