// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/mirror_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "shapemap/core/angles.hpp"
#include "shapemap/scan/joined_logs.hpp"

namespace shapemap {
namespace {

constexpr double kLeastTurn_rad = 5 * kDegree;

/// Turns by more than this are not certain to be no turns the other way.
constexpr double kMostTurn_rad = 150 * kDegree;

constexpr double kByChance = 0.5;
constexpr double kLogError = -13.8;  // 1e-6

}  // namespace

bool TurnComparison::is_mirrored() const {
  // The number of opposite turns is binomial; by Chernoff's bound, so many or more have at most this probability.
  const auto count = static_cast<double>(num_alike + num_opposite);
  if (count == 0.0) return false;
  const double share = static_cast<double>(num_opposite) / count;
  if (share <= kByChance) return false;
  double divergence = share * std::log(share / kByChance);
  if (share < 1.0) divergence += (1.0 - share) * std::log((1.0 - share) / (1.0 - kByChance));
  return -count * divergence < kLogError;
}

TurnComparison compare_turns(const Log& log, const std::vector<PlacedScan>& placed) {
  TurnComparison turns;
  const PlacedScan* since = nullptr;  // turns are looked at as soon as they are large enough
  for (const PlacedScan& here : placed) {
    const std::optional<double>& after = log.scans[here.scan_index].recorded_heading_rad;
    if (!after) continue;
    if (since == nullptr || part_with(log, since->scan_index) != part_with(log, here.scan_index)) {
      since = &here;
      continue;
    }
    const double recorded_rad = wrap_angle(*after - *log.scans[since->scan_index].recorded_heading_rad);
    const double mapped_rad = wrap_angle(here.map_from_robot.theta_rad - since->map_from_robot.theta_rad);
    const double smaller_rad = std::min(std::abs(recorded_rad), std::abs(mapped_rad));
    const double larger_rad = std::max(std::abs(recorded_rad), std::abs(mapped_rad));
    if (larger_rad < kLeastTurn_rad) continue;
    since = &here;
    if (smaller_rad < 0.5 * kLeastTurn_rad || larger_rad > kMostTurn_rad) continue;
    ++((recorded_rad > 0.0) == (mapped_rad > 0.0) ? turns.num_alike : turns.num_opposite);
  }
  return turns;
}

}  // namespace shapemap
