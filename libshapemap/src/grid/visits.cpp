// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/grid/visits.hpp"

namespace shapemap {
namespace {

constexpr double kVisitStep_m = 0.5;
constexpr double kVisitTurn_rad = 20 * kDegree;

}  // namespace

std::vector<std::size_t> starts_of_visits(const std::vector<PlacedScan>& placed) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (!starts.empty()) {
      const Pose2 step = inverse(placed[starts.back()].map_from_robot) * placed[i].map_from_robot;
      if (is_within(step, {kVisitStep_m, kVisitTurn_rad})) continue;
    }
    starts.push_back(i);
  }
  starts.push_back(placed.size());
  return starts;
}

}  // namespace shapemap
