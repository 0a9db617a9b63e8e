// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/scan.hpp"

/// These functions convert single scans and frames to and from MRPT's serialised objects. MRPT's headers stay in
/// rawlog_objects.cpp.
namespace shapemap {

struct RawlogScan {
  Sweep sweep;
  std::optional<double> timestamp_s;  ///< Unix time; nothing when the rawlog does not state it
};

/// Reads one serialised CObservation2DRangeScan. Throws std::runtime_error with MRPT's reason.
RawlogScan scan_from_rawlog(std::string_view object);

/// Returns a serialised CSensoryFrame with the sweeps of `scan`.
std::string frame_to_rawlog(const Scan& scan);

/// Returns a serialised CActionCollection with one odometry increment, or with none.
std::string action_to_rawlog(const std::optional<Pose2>& previous_from_current, double timestamp_s);

}  // namespace shapemap
