// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string_view>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/scan.hpp"

/// The readings of some logs are not in metres, although nothing says so.
namespace shapemap {

enum class RangeUnit { kAuto, kMetre, kCentimetre, kMillimetre };

template <>
struct EnumNames<RangeUnit> {
  static constexpr std::array<std::string_view, 4> names{"auto", "m", "cm", "mm"};
};

/// Returns the length of a unit in metres; kAuto counts as a metre.
double metres_per(RangeUnit unit);

/// Recognises the unit of the readings of a log: no sensor measures half of its distances beyond 100 m. Of the two
/// smaller units, the one is meant that gives the more usual distances and roughness of surfaces.
RangeUnit recognised_range_unit(const Log& log);

/// Converts readings that were taken for metres into metres. A range limit of a header is converted too, unless it is
/// below half of the readings.
void scale_ranges(Log& log, RangeUnit unit);

}  // namespace shapemap
