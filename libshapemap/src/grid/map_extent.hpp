// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "shapemap/grid/placed_rays.hpp"
#include "shapemap/scan/placed_scan.hpp"

/// Which part of the plane a picture shows. A single false reading of 900 m, or a few beams through a window, would
/// else make a picture that is empty but for a dot at its rim.
namespace shapemap {

struct Box {
  Point2 lower_m = Point2::Constant(std::numeric_limits<double>::infinity());
  Point2 upper_m = Point2::Constant(-std::numeric_limits<double>::infinity());

  void include(const Point2& p_m) {
    lower_m = {std::min(lower_m.x(), p_m.x()), std::min(lower_m.y(), p_m.y())};
    upper_m = {std::max(upper_m.x(), p_m.x()), std::max(upper_m.y(), p_m.y())};
  }
};

/// What one sub-scan saw, and what it is worth as evidence.
struct SeenRays {
  Rays rays;
  std::uint32_t look = 0;  ///< number of the look that it belongs to, from 1
  bool contradicts_map = false;
};

/// Holds all positions, sensors and hits.
Box box_of_all(const std::vector<SeenRays>& seen, const std::vector<PlacedScan>& placed);

/// Holds all positions and sensors, and the hits that are certain enough for the room that they take:
///
/// - The plane is divided into cells of about a tenth of the usual range, so that no length is fixed. A cell is a
///   surface when neighbouring beams of one sub-scan end side by side in it, or in line with two more, or when hits of
///   two looks lie in it or beside it; else it holds lone hits, which count a tenth.
/// - The core of the map is the rectangle for which the share of what is known that it holds, less 0.03 times the
///   logarithm of its area, is largest: a picture that is ten times larger must show 7 % more of what is known.
/// - Where the whole is no more than four times as large as the core, all is held, so that nothing is cut off for a
///   small gain. Else the picture is up to twice as large as the core, to hold as much as possible of the rest.
///
/// A single position cannot be checked by others, and all that it saw is held. `all` is box_of_all().
Box certain_box(const std::vector<SeenRays>& seen, const std::vector<PlacedScan>& placed, const Box& all);

}  // namespace shapemap
