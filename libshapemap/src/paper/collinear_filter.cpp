// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <iterator>

#include "shapemap/paper/filters.hpp"

namespace shapemap {
namespace {

/// Returns the angle between two lines without direction, in [0, pi / 2].
double line_angle_rad(double a_rad, double b_rad) {
  const double angle_rad = angle_between(a_rad, b_rad);
  return std::min(angle_rad, kPi - angle_rad);
}

}  // namespace

Correspondences collinear_filter(const Correspondences& correspondences, const FilterOptions& options) {
  const auto slides = [&](const Correspondence& c) {
    const Point2 t = c.translation_m();
    if (t.squaredNorm() == 0.0) return false;
    const double direction_rad = std::atan2(t.y(), t.x());
    return line_angle_rad(direction_rad, c.query_tangent_rad) <= options.collinear_angle_rad ||
           line_angle_rad(direction_rad, c.target_tangent_rad) <= options.collinear_angle_rad;
  };
  Correspondences kept;
  std::remove_copy_if(correspondences.begin(), correspondences.end(), std::back_inserter(kept), slides);
  return kept;
}

}  // namespace shapemap
