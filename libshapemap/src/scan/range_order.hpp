// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "level_extent.hpp"
#include "range_sample.hpp"

namespace shapemap {

/// Counts the readings beyond some distance in the sweeps of a sensor, without those on levels of no return.
struct FarReadings {
  std::size_t num_readings = 0;
  std::size_t num_in_order = 0;  ///< readings that continue that of a neighbouring beam
  std::size_t num_all = 0;       ///< readings at any distance

  /// Says whether the readings are surfaces rather than scattered false readings.
  bool are_surfaces() const;
};

/// Counts the readings beyond `from_mm` and below `end_mm`.
FarReadings readings_beyond(const std::vector<Sweep*>& sweeps, Millimetres from_mm, Millimetres end_mm,
                            const std::vector<LevelExtent>& levels);

}  // namespace shapemap
