// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "level_test.hpp"
#include "range_sample.hpp"

namespace shapemap {

/// The shortest and the longest distance of a level; both are inclusive.
struct LevelExtent {
  Millimetres from_mm = 0;
  Millimetres to_mm = 0;
};

/// Returns the whole level and no more than it: from the first to the last distance near `window` that stands out of
/// the readings around it. `resolution_mm` is that of the sensor.
LevelExtent extent_of(const std::vector<Sweep*>& sweeps, const LevelWindow& window, Millimetres resolution_mm);

}  // namespace shapemap
