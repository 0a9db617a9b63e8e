// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/scan/placed_scan.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// What one laser saw from one place, in the map frame.
struct Rays {
  Point2 from_m{0.0, 0.0};
  std::vector<Point2> hits_m;  ///< in the order of the beams
  double beam_step_rad = 0.0;  ///< mean angle between neighbouring beams, with or without a return
};

/// Of each sub-scan of a position that has any. A sensor that is tilted beyond the limit has no hits and stays out.
std::vector<Rays> rays_of(const Log& log, const PlacedScan& place, const ReturnOptions& options);

/// Beams of one laser that hit nothing, in the map frame.
struct OpenRays {
  Point2 from_m{0.0, 0.0};
  std::vector<Point2> ends_m;
};

/// Of each sub-scan of a position that has any; they end after `length_m`, or as in open_ends_in_robot().
std::vector<OpenRays> open_rays_of(const Log& log, const PlacedScan& place, const ReturnOptions& options,
                                   double length_m);

}  // namespace shapemap
