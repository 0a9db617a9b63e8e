// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/mapper/map_result.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// The turns of the robot in the map, compared with those of the headings that are recorded with the scans.
struct TurnComparison {
  std::size_t num_alike = 0;
  std::size_t num_opposite = 0;

  /// Returns whether the scans must be mirrored: if the recorded headings had nothing to do with the motion, so many
  /// opposite turns would have a probability below 1e-6.
  bool is_mirrored() const;
};

/// Compares the turns between successive placed scans of one session that are too large to be noise; `sessions` holds
/// the session of each of `scans`. A laser that is upside down, or counts its beams clockwise, makes a map that is only
/// mirrored, which nothing but recorded headings can show.
TurnComparison compare_turns(const std::vector<Scan>& scans, const std::vector<std::size_t>& sessions,
                             const std::vector<PlacedScan>& placed);

}  // namespace shapemap
