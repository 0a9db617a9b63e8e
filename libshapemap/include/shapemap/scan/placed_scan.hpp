// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// The consistency of a scan with the map of all scans from elsewhere; each number is a share of the beams that
/// returned.
struct ScanConsistency {
  double agree = 0.0;            ///< beams that end on a surface that other scans saw
  double through = 0.0;          ///< beams that pass through a surface that other scans saw
  double in_free = 0.0;          ///< beams that end in space that other scans saw as free
  bool contradicts_map = false;  ///< `through` and `in_free` are too large a share of known()

  /// The remaining beams end where no other scan has seen anything.
  double known() const { return agree + through + in_free; }
};

/// A placed scan is a scan with its pose.
struct PlacedScan {
  std::size_t scan_index = 0;  ///< index into the list of scans that functions take beside it
  double timestamp_s = 0.0;
  Pose2 map_from_robot;
  /// Decoupled ICP corrects each sweep a little. This is the pose of the sweep's robot frame in the scan's robot frame,
  /// one per sweep.
  std::vector<Pose2> robot_from_sweep;
  ScanConsistency consistency{};  ///< consistency with the rest of the component; see scan_consistency.hpp
};

/// Scans that trusted edges connect; their poses are relative to the first of them.
struct Component {
  std::vector<PlacedScan> scans;
};

}  // namespace shapemap
