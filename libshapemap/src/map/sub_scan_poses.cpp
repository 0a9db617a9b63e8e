// SPDX-License-Identifier: GPL-3.0-or-later
#include "sub_scan_poses.hpp"

#include <algorithm>

#include "shapemap/core/parallel_for.hpp"
#include "shapemap/graph/loop_closing.hpp"
#include "shapemap/graph/sub_scan_refinement.hpp"

namespace shapemap {
namespace {

SubScanViews views_of_sub_scans(const Log& log, const KeyframeChain& chain, const MappingOptions& options) {
  SubScanViews views(chain.keyframes.size());
  parallel_for(views.size(), options.chain.threads, [&](std::size_t i) {
    for (const SubScan& sub_scan : log.positions[chain.keyframes[i].position_index].sub_scans) {
      Position alone;
      alone.sub_scans = {sub_scan};
      views[i].push_back(std::make_shared<ScanView>(
          view_of(alone, options.returns, options.polylines, options.shape, options.robust.view)));
    }
  });
  return views;
}

}  // namespace

SubScanCorrections refine_sub_scans_of_map(const Log& log, const KeyframeChain& chain, const MappingOptions& options,
                                           RunObserver& observer, KeyframeMap& map) {
  const bool has_several = std::any_of(chain.keyframes.begin(), chain.keyframes.end(), [&](const Keyframe& keyframe) {
    return log.positions[keyframe.position_index].sub_scans.size() > 1;
  });
  if (!has_several || options.sub_scans.rounds == 0) return {};
  SubScanPoses poses = refine_sub_scans(views_of_sub_scans(log, chain, options), map.map_from_keyframe, map.component,
                                        link_constraints(chain, map.link_choice), options.robust.search.line,
                                        options.sub_scans, options.chain.threads, observer);
  map.map_from_keyframe = std::move(poses.map_from_node);
  return std::move(poses.node_from_sub_scan);
}

}  // namespace shapemap
