// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/mirror_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mapper_numbers.hpp"
#include "shapemap/core/angles.hpp"

namespace shapemap {
bool TurnComparison::is_mirrored() const {
  const MirrorNumbers& numbers = kMapper.mirror;
  // The number of opposite turns is binomial, and Chernoff's bound limits the probability of so many or more.
  const auto count = static_cast<double>(num_alike + num_opposite);
  if (count == 0.0) return false;
  const double share = static_cast<double>(num_opposite) / count;
  if (share <= numbers.by_chance) return false;
  double divergence = share * std::log(share / numbers.by_chance);
  if (share < 1.0) divergence += (1.0 - share) * std::log((1.0 - share) / (1.0 - numbers.by_chance));
  return -count * divergence < numbers.log_error;
}

TurnComparison compare_turns(const std::vector<Scan>& scans, const std::vector<std::size_t>& sessions,
                             const std::vector<PlacedScan>& placed) {
  const MirrorNumbers& numbers = kMapper.mirror;
  TurnComparison turns;
  const PlacedScan* since = nullptr;  // turns add up from here until they are large enough
  for (const PlacedScan& here : placed) {
    const std::optional<double>& after = scans[here.scan_index].recorded_heading_rad;
    if (!after) continue;
    if (since == nullptr || sessions.at(since->scan_index) != sessions.at(here.scan_index)) {
      since = &here;
      continue;
    }
    const double recorded_rad = wrap_angle(*after - *scans[since->scan_index].recorded_heading_rad);
    const double mapped_rad = wrap_angle(here.map_from_robot.theta_rad - since->map_from_robot.theta_rad);
    const double smaller_rad = std::min(std::abs(recorded_rad), std::abs(mapped_rad));
    const double larger_rad = std::max(std::abs(recorded_rad), std::abs(mapped_rad));
    if (larger_rad < numbers.least_turn_rad) continue;
    since = &here;
    if (smaller_rad < 0.5 * numbers.least_turn_rad || larger_rad > numbers.most_turn_rad) continue;
    ++((recorded_rad > 0.0) == (mapped_rad > 0.0) ? turns.num_alike : turns.num_opposite);
  }
  return turns;
}

}  // namespace shapemap
