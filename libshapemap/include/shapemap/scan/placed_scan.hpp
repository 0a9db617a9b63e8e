// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// What became of the beams of a scan that returned, in the map that the scans from elsewhere make; as shares of them.
struct ScanConsistency {
  double agree = 0.0;            ///< end on a surface that others saw
  double through = 0.0;          ///< went through a surface that others saw, and on
  double in_free = 0.0;          ///< end where others looked through
  bool contradicts_map = false;  ///< too many of the last two among what is known

  /// The rest ends where nobody else has looked.
  double known() const { return agree + through + in_free; }
};

/// One position of the log with a pose.
struct PlacedScan {
  std::size_t scan_index = 0;  ///< into Log::positions
  double timestamp_s = 0.0;
  Pose2 map_from_robot;
  /// Small corrections of each sub-scan found by decoupled ICP: pose of the sub-scan's robot frame in the
  /// position's robot frame. One per sub-scan of the position.
  std::vector<Pose2> robot_from_sweep;
  ScanConsistency consistency{};  ///< with the rest of the fragment; see scan_agreement.hpp
};

/// Positions that are connected by trusted alignments; poses are relative to its first position.
struct Component {
  std::vector<PlacedScan> scans;
};

}  // namespace shapemap
