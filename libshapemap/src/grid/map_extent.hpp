// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "shapemap/grid/placed_rays.hpp"
#include "shapemap/scan/placed_scan.hpp"

/// The extent of a picture is a part of the plane. A single false reading of 900 m, or a few beams through a window,
/// would otherwise make a picture that is empty but for a dot at its rim.
namespace shapemap {

struct Box {
  Point2 lower_m = Point2::Constant(std::numeric_limits<double>::infinity());
  Point2 upper_m = Point2::Constant(-std::numeric_limits<double>::infinity());

  void include(const Point2& p_m) {
    lower_m = {std::min(lower_m.x(), p_m.x()), std::min(lower_m.y(), p_m.y())};
    upper_m = {std::max(upper_m.x(), p_m.x()), std::max(upper_m.y(), p_m.y())};
  }
};

/// The rays of one sweep count as evidence according to its visit.
struct SeenRays {
  Rays rays;
  std::uint32_t visit = 0;  ///< number of the visit that the sweep belongs to, from 1
  bool contradicts_map = false;
};

/// Returns the box of all scans, sensors and returns.
Box box_of_all(const std::vector<SeenRays>& seen, const std::vector<PlacedScan>& placed);

/// Returns the box of all scans and sensors, and of the returns that are certain enough for the space that they take:
///
/// - The plane is divided into cells of about a tenth of the usual range, so that no length is fixed. A cell is a
///   surface when neighbouring beams of one sweep end side by side in it, or in line with two more, or when returns of
///   two visits lie in it or beside it; else it holds lone returns, which count a tenth.
/// - The core of the map is the rectangle for which the share of the known cells that it holds, less 0.03 times the
///   logarithm of its area, is largest: a picture that is ten times larger must show 7 % more of what is known.
/// - Where the whole is no more than four times as large as the core, the box holds all, so that nothing is cut off for
///   a small gain. Else the picture is up to twice as large as the core, to hold as much as possible of the rest.
///
/// A single scan cannot be checked by others, and the box holds all that it saw. `all` is box_of_all().
Box certain_box(const std::vector<SeenRays>& seen, const std::vector<PlacedScan>& placed, const Box& all);

}  // namespace shapemap
