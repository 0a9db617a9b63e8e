// SPDX-License-Identifier: GPL-3.0-or-later
#include "range_order.hpp"

#include <algorithm>
#include <cstdlib>

namespace shapemap {
namespace {

constexpr std::size_t kFewestOfSurfaces = 10;
constexpr double kFewestInOrder = 0.5;   // as a share of the far readings
constexpr double kMostScattered = 0.05;  // as a share of all readings, which may be false ones

}  // namespace

bool FarReadings::are_surfaces() const {
  const auto count = static_cast<double>(num_readings);
  if (count > kMostScattered * static_cast<double>(num_all)) return true;
  return num_in_order >= kFewestOfSurfaces && static_cast<double>(num_in_order) > kFewestInOrder * count;
}

FarReadings readings_beyond(const std::vector<Sweep*>& sweeps, Millimetres from_mm, Millimetres end_mm,
                            const std::vector<LevelExtent>& levels) {
  FarReadings far;
  const auto is_far = [&](Millimetres range_mm) {
    return range_mm > from_mm && range_mm < end_mm &&
           std::none_of(levels.begin(), levels.end(),
                        [&](const LevelExtent& level) { return level.from_mm <= range_mm && range_mm <= level.to_mm; });
  };
  for (const Sweep* sweep : sweeps) {
    const double step_rad = beam_step_rad(*sweep);
    Millimetres before_mm = 0;
    bool before_counted = false;
    for (const float range_m : sweep->ranges_m) {
      Millimetres range_mm = to_mm(range_m, *sweep);
      if (range_mm > 0) ++far.num_all;
      if (!is_far(range_mm)) range_mm = 0;
      const bool follows =
          range_mm > 0 && before_mm > 0 &&
          std::abs(range_mm - before_mm) <= continuity_mm(std::min(range_mm, before_mm), step_rad, 1, kUsualNoise_mm);
      if (range_mm > 0) ++far.num_readings;
      if (follows) far.num_in_order += before_counted ? 1 : 2;
      before_mm = range_mm;
      before_counted = follows;
    }
  }
  return far;
}

}  // namespace shapemap
