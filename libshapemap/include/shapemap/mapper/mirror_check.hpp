// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/mapper/map_result.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// How often the robot turned as the map says, and how often the other way, by the headings that are recorded with the
/// scans.
struct TurnComparison {
  std::size_t num_alike = 0;
  std::size_t num_opposite = 0;

  /// Whether the scans must be mirrored: more turns are opposite than would be, with a probability of 1e-6, if the
  /// recorded headings had nothing to do with the motion.
  bool is_mirrored() const;
};

/// Compares the turns between successive placed scans of one session that are too large to be noise; `sessions` holds
/// the session of each of `scans`. Scans of a laser that is upside down, or counts its beams clockwise, make a map that
/// is right but for being mirrored: nothing else tells.
TurnComparison compare_turns(const std::vector<Scan>& scans, const std::vector<std::size_t>& sessions,
                             const std::vector<PlacedScan>& placed);

}  // namespace shapemap
