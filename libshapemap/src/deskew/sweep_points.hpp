// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// What a beam of a moving robot hit, as the robot saw it at the time of that beam.
struct SweepPoint {
  Point2 p_m;
  std::size_t sweep = 0;     ///< index into Position::sweeps
  std::size_t beam = 0;      ///< and into its ranges
  bool begins_line = false;  ///< the point before it is of another sub-scan
};

/// The hits of all sub-scans of a position, in the order in which their beams were sent; about `max_points` of them,
/// evenly spread over the beams.
std::vector<SweepPoint> sweep_points(const Scan& scan, const ReturnOptions& options, std::size_t max_points);

}  // namespace shapemap
