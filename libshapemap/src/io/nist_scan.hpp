// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "shapemap/scan/beam_angles.hpp"
#include "shapemap/scan/scan.hpp"
#include "text.hpp"

/// The `sensor` and `scan` statements of our text format.
namespace shapemap {

/// Of the numbers of a file.
struct NistUnits {
  double metres_per_unit = 1.0;
  double radians_per_unit = kDegree;
};

/// What a `sensor` line says of the scans of a laser, and a `scan` line of one of them.
struct NistHeader {
  Sweep sweep;                           ///< without readings
  StatedAngles angles;                   ///< of evenly spaced beams
  std::optional<std::size_t> num_beams;  ///< nothing: any
  bool has_own_angles = false;           ///< something was said of them on this very line
};

/// Reads a `sensor` line from behind its keyword on. Throws InputError.
NistHeader read_nist_sensor(Words& words, const LineReader& lines, const NistUnits& units);

/// What is odd about the headers of scans, and was mended.
struct NistOddities {
  std::size_t num_by_step = 0;    ///< step and last angle contradict each other; the step is used
  std::size_t num_by_limits = 0;  ///< the step cannot be; first and last angle are used
  std::size_t num_without = 0;    ///< what a scan itself says of its angles cannot be; it is left without readings
};

/// Reads a `scan` line from behind the sensor's name on; what it does not say is as `sensor` says. Throws InputError.
Sweep read_nist_scan(Words& words, const LineReader& lines, const NistUnits& units, const NistHeader& sensor,
                     NistOddities& oddities);

}  // namespace shapemap
