// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/scan/placed_scan.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// Rays are the returns of one laser from one place, in the map frame.
struct Rays {
  Point2 from_m{0.0, 0.0};
  std::vector<Point2> hits_m;  ///< in the order of the beams
  double beam_step_rad = 0.0;  ///< mean angle between neighbouring beams, with or without a return
};

/// Returns the rays of each sweep of a scan that has any. A sensor that is tilted beyond the limit has no returns and
/// stays out.
std::vector<Rays> rays_of(const std::vector<Scan>& scans, const PlacedScan& place, const ReturnOptions& options);

/// Open rays are the beams of one laser that hit nothing, in the map frame.
struct OpenRays {
  Point2 from_m{0.0, 0.0};
  std::vector<Point2> ends_m;
};

/// Returns the open rays of each sweep of a scan that has any; they end after `length_m`, or as in
/// open_ends_in_robot().
std::vector<OpenRays> open_rays_of(const std::vector<Scan>& scans, const PlacedScan& place,
                                   const ReturnOptions& options, double length_m);

}  // namespace shapemap
