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

/// A graph and its optimised map.
struct SolvedGraph {
  const KeyframeGraph& graph;
  const OptimizedMap& map;
  const SweepCorrections& sweeps;
};

/// Places all scans by the poses of their keyframes: it fills in the components of `result`, and the result of each
/// scan, for which there is an entry. `num_sweeps` has an entry for each scan.
void build_trajectory(const SolvedGraph& solved, const std::vector<std::size_t>& num_sweeps,
                      const ConfidenceOptions& options, MappingEvents& events, MapResult& result);

}  // namespace shapemap
