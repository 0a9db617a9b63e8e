// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string_view>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/scan.hpp"

/// Logs whose readings are no metres, though nothing says so.
namespace shapemap {

enum class RangeUnit { kAuto, kMetre, kCentimetre, kMillimetre };

template <>
struct EnumNames<RangeUnit> {
  static constexpr std::array<std::string_view, 4> names{"auto", "m", "cm", "mm"};
};

/// The length of a unit; a metre for kAuto.
double metres_per(RangeUnit unit);

/// The unit that the readings of a log are in: no sensor has half of the distances that it measures beyond 100 m.
/// Of the two smaller units, that one is meant whose distances and roughness of surfaces are the more usual.
RangeUnit recognised_range_unit(const Log& log);

/// Turns readings that were taken for metres into metres. A range limit of a header is in the same unit unless it is
/// below half of the readings.
void scale_ranges(Log& log, RangeUnit unit);

}  // namespace shapemap
