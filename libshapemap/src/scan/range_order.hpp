// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "level_extent.hpp"
#include "range_sample.hpp"

namespace shapemap {

/// What lies beyond some distance in the sweeps of a sensor, levels of no return left out.
struct FarReadings {
  std::size_t num_readings = 0;
  std::size_t num_in_order = 0;  ///< that continue the reading of a neighbouring beam
  std::size_t num_all = 0;       ///< of all distances

  /// Whether they are surfaces, rather than scattered false readings.
  bool are_surfaces() const;
};

/// Beyond `from_mm` and below `end_mm`.
FarReadings readings_beyond(const std::vector<Sweep*>& sweeps, Millimetres from_mm, Millimetres end_mm,
                            const std::vector<LevelExtent>& levels);

}  // namespace shapemap
