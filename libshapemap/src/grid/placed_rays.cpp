// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/grid/placed_rays.hpp"

#include <cmath>
#include <utility>

namespace shapemap {
namespace {

/// Calls `visit(sweep, map_from_sweep)` for each sweep of the scan.
template <class Visit>
void for_each_sweep(const std::vector<Scan>& scans, const PlacedScan& place, const Visit& visit) {
  const std::vector<Sweep>& sweeps = scans.at(place.scan_index).sweeps;
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    visit(sweeps[i], place.map_from_robot * place.robot_from_sweep.at(i));
  }
}

}  // namespace

std::vector<Rays> rays_of(const std::vector<Scan>& scans, const PlacedScan& place, const ReturnOptions& options) {
  std::vector<Rays> all;
  for_each_sweep(scans, place, [&](const Sweep& sweep, const Pose2& map_from_sweep) {
    const std::vector<Return> returns = returns_in_robot(sweep, options);
    if (returns.empty()) return;
    Rays rays;
    rays.hits_m.reserve(returns.size());
    for (const Return& hit : returns) rays.hits_m.push_back(map_from_sweep * hit.p_in_robot_m);
    rays.from_m = map_from_sweep * robot_from_sensor2(sweep).translation();
    rays.beam_step_rad = std::abs(sweep.angle_step_rad);
    all.push_back(std::move(rays));
  });
  return all;
}

std::vector<OpenRays> open_rays_of(const std::vector<Scan>& scans, const PlacedScan& place,
                                   const ReturnOptions& options, double length_m) {
  std::vector<OpenRays> all;
  for_each_sweep(scans, place, [&](const Sweep& sweep, const Pose2& map_from_sweep) {
    OpenRays rays;
    for (const Point2& end_in_robot_m : open_ends_in_robot(sweep, options, length_m)) {
      rays.ends_m.push_back(map_from_sweep * end_in_robot_m);
    }
    if (rays.ends_m.empty()) return;
    rays.from_m = map_from_sweep * robot_from_sensor2(sweep).translation();
    all.push_back(std::move(rays));
  });
  return all;
}

}  // namespace shapemap
