// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_snapshot.hpp"

#include <map>
#include <utility>

namespace shapemap {
namespace {

/// Numbers the components in the order of their first scans, and puts each into the frame of that scan.
void normalize(Map& map) {
  std::map<int, std::pair<int, Pose2>> known;  // number and first_from_map, by component
  for (ScanPose& scan : map.scans) {
    if (scan.component < 0) continue;
    const auto number = static_cast<int>(known.size());
    const auto [found, is_new] = known.try_emplace(scan.component, number, inverse(scan.map_from_robot));
    scan.component = found->second.first;
    scan.map_from_robot = is_new ? Pose2{} : found->second.second * scan.map_from_robot;
  }
  map.num_components = static_cast<int>(known.size());
}

}  // namespace

Map map_snapshot(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t num_scans) {
  Map snapshot;
  snapshot.scans.resize(num_scans);
  for (std::size_t i = 0; i < graph.keyframes.size(); ++i) {
    const std::size_t scan = graph.keyframes[i].scan_index;
    snapshot.keyframes.push_back(scan);
    snapshot.scans[scan] = {static_cast<int>(map.component[i]), map.map_from_keyframe[i]};
  }
  for (const AttachedScan& scan : graph.attached) {
    snapshot.scans[scan.scan_index] = {static_cast<int>(map.component[scan.keyframe]),
                                       map.map_from_keyframe[scan.keyframe] * scan.pose.ref_from_query};
  }
  snapshot.loops = map.loops;
  normalize(snapshot);
  return snapshot;
}

Map map_snapshot(const MapResult& result) {
  Map snapshot;
  snapshot.scans.resize(result.scans.size());
  for (std::size_t k = 0; k < result.components.size(); ++k) {
    for (const PlacedScan& placed : result.components[k].scans) {
      snapshot.scans[placed.scan_index] = {static_cast<int>(k), placed.map_from_robot};
    }
  }
  for (const ScanResult& scan : result.scans) {
    if (scan.component >= 0 && scan.is_keyframe) snapshot.keyframes.push_back(scan.scan_index);
  }
  snapshot.loops = result.loops;
  snapshot.num_components = static_cast<int>(result.components.size());
  snapshot.is_final = true;
  return snapshot;
}

}  // namespace shapemap
