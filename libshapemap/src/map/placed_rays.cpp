// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/map/placed_rays.hpp"

#include <utility>

namespace shapemap {

std::vector<Rays> rays_of(const Log& log, const PlacedPosition& place, const ReturnOptions& options) {
  std::vector<Rays> all;
  const std::vector<SubScan>& sub_scans = log.positions.at(place.position_index).sub_scans;
  for (std::size_t i = 0; i < sub_scans.size(); ++i) {
    const Pose2 map_from_sub_scan = place.map_from_robot * place.robot_from_sub_scan.at(i);
    Rays rays;
    for (const Return& hit : returns_in_robot(sub_scans[i], options)) {
      rays.hits_m.push_back(map_from_sub_scan * hit.p_in_robot_m);
    }
    if (rays.hits_m.empty()) continue;
    rays.from_m = map_from_sub_scan * robot_from_sensor2(sub_scans[i]).translation();
    all.push_back(std::move(rays));
  }
  return all;
}

}  // namespace shapemap
