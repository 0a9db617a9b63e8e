// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "shapemap/scan/beam_angles.hpp"
#include "shapemap/scan/scan.hpp"
#include "text.hpp"

/// This header reads the `sensor` and `scan` statements of the text format.
namespace shapemap {

/// The numbers of a file have these units.
struct NistUnits {
  double metres_per_unit = 1.0;
  double radians_per_unit = kDegree;
};

/// A `sensor` line states this about the sweeps of a laser, and a `scan` line about one of them.
struct NistHeader {
  Sweep sweep;                           ///< without readings
  StatedAngles angles;                   ///< directions of evenly spaced beams
  std::optional<std::size_t> num_beams;  ///< nothing allows any number
  bool has_own_angles = false;           ///< the line itself states angles
};

/// Reads a `sensor` line after its keyword. Throws InputError.
NistHeader read_nist_sensor(Words& words, const LineReader& lines, const NistUnits& units);

/// Counts the sweeps with odd headers that were mended.
struct NistOddities {
  std::size_t num_by_step = 0;    ///< step and last angle contradict each other; the step is used
  std::size_t num_by_limits = 0;  ///< the step is impossible; first and last angle are used
  std::size_t num_without = 0;    ///< the sweep's own angles are impossible; it is left without readings
};

/// Reads a `scan` line after the sensor's name; `sensor` has what the line does not state. Throws InputError.
Sweep read_nist_sweep(Words& words, const LineReader& lines, const NistUnits& units, const NistHeader& sensor,
                      NistOddities& oddities);

}  // namespace shapemap
