// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// The robot saw this point at the time of the beam, while it moved.
struct SweepPoint {
  Point2 p_m;
  std::size_t sweep = 0;     ///< index into Scan::sweeps
  std::size_t beam = 0;      ///< index into Sweep::ranges_m
  bool begins_line = false;  ///< the point before it is of another sweep
};

/// Returns the points of all sweeps of a scan, in the order in which their beams were sent; about `max_points` of them,
/// evenly spread over the beams.
std::vector<SweepPoint> sweep_points(const Scan& scan, const ReturnOptions& options, std::size_t max_points);

}  // namespace shapemap
