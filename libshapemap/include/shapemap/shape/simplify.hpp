// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// Returns the vertices (indices into `points`, ascending, first and last included) of a simpler polyline that stays
/// within about `tolerance_m` of the given one. CGAL's polyline simplification does it, with the squared distance as
/// cost.
std::vector<std::size_t> simplify_polyline(const std::vector<Point2>& points, double tolerance_m);

}  // namespace shapemap
