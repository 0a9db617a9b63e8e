// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_poses.hpp"

#include <algorithm>

#include "shapemap/core/parallel_for.hpp"
#include "shapemap/inference/map_search.hpp"
#include "shapemap/inference/sweep_refinement.hpp"

namespace shapemap {
SubScanCorrections refine_sub_scans_of_map(const KeyframeChain& chain, const RobustOptions& options,
                                           const Execution& execution, KeyframeMap& map) {
  const bool has_several = std::any_of(chain.keyframes.begin(), chain.keyframes.end(),
                                       [](const Keyframe& keyframe) { return !keyframe.sweep_views.empty(); });
  if (!has_several || options.sweep_refinement.rounds == 0) return {};
  SubScanViews views;
  for (const Keyframe& keyframe : chain.keyframes) {
    if (keyframe.sweep_views.empty()) {
      views.push_back({keyframe.view});
    } else {
      views.push_back(keyframe.sweep_views);
    }
  }
  SubScanPoses poses =
      refine_sub_scans(views, map.map_from_keyframe, map.component, link_constraints(chain, map.link_choice),
                       options.matcher.search.line, options.sweep_refinement, execution.threads, execution.observer);
  map.map_from_keyframe = std::move(poses.map_from_node);
  return std::move(poses.node_from_sub_scan);
}

}  // namespace shapemap
