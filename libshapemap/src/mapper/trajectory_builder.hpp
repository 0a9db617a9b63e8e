// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "inference/optimized_map.hpp"
#include "inference/sweep_poses.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapping_events.hpp"
#include "shapemap/matching/scan_matcher.hpp"

namespace shapemap {

/// A graph and the map that it was solved for.
struct SolvedGraph {
  const KeyframeGraph& graph;
  const OptimizedMap& map;
  const SweepCorrections& sweeps;
};

/// Places all scans in `result`, which has an entry for each, by the poses of their keyframes: fills in the components,
/// and what became of each scan. `num_sweeps` has an entry for each scan.
void build_trajectory(const SolvedGraph& solved, const std::vector<std::size_t>& num_sweeps,
                      const ConfidenceOptions& options, MappingEvents& events, MapResult& result);

}  // namespace shapemap
