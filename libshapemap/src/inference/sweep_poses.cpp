// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_poses.hpp"

#include <algorithm>

#include "shapemap/core/parallel_for.hpp"
#include "shapemap/inference/map_search.hpp"
#include "shapemap/inference/sweep_refinement.hpp"

namespace shapemap {
SweepCorrections refine_sweeps_of_map(const KeyframeGraph& graph, const RobustOptions& options,
                                      const Execution& execution, OptimizedMap& map) {
  const bool has_several = std::any_of(graph.keyframes.begin(), graph.keyframes.end(),
                                       [](const Keyframe& keyframe) { return !keyframe.sweep_views.empty(); });
  if (!has_several || options.sweep_refinement.rounds == 0) return {};
  SweepViews views;
  for (const Keyframe& keyframe : graph.keyframes) {
    if (keyframe.sweep_views.empty()) {
      views.push_back({keyframe.view});
    } else {
      views.push_back(keyframe.sweep_views);
    }
  }
  const std::vector<PoseConstraint> known = edge_constraints(graph, map.edge_choice);
  SweepPoses poses = refine_sweeps(views, {map.map_from_keyframe, map.component, known}, options.matcher.search.line,
                                   options.sweep_refinement, execution);
  map.map_from_keyframe = std::move(poses.map_from_node);
  return std::move(poses.node_from_sweep);
}

}  // namespace shapemap
