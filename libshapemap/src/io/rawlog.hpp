// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/scan.hpp"

/// Single scans and frames to and from MRPT's serialised objects. MRPT's headers stay in rawlog_objects.cpp.
namespace shapemap {

struct RawlogScan {
  Sweep sweep;
  std::optional<double> timestamp_s;  ///< Unix time; nothing when the rawlog does not know it
};

/// One serialised CObservation2DRangeScan. Throws std::runtime_error with MRPT's reason.
RawlogScan scan_from_rawlog(std::string_view object);

/// A serialised CSensoryFrame with the sub-scans of `position`.
std::string frame_to_rawlog(const Scan& scan);

/// A serialised CActionCollection with one odometry increment, or with none.
std::string action_to_rawlog(const std::optional<Pose2>& previous_from_current, double timestamp_s);

}  // namespace shapemap
