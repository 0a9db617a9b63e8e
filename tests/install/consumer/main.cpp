// SPDX-License-Identifier: GPL-3.0-or-later
// Headers and symbols of several stages, as found through the installed package.
#include <iostream>

#include "shapemap/core/version.hpp"
#include "shapemap/mapper/map_log.hpp"
#include "shapemap/scan/returns.hpp"

int main() {
  shapemap::validate_all(shapemap::MappingOptions{});

  shapemap::Sweep sweep;
  sweep.ranges_m = {1.0F, 2.0F};
  sweep.angle_step_rad = shapemap::kPi / 2;
  const auto returns = shapemap::returns_in_robot(sweep, {});
  const bool as_expected = returns.size() == 2 && (returns[1].p_in_robot_m - shapemap::Point2(0.0, 2.0)).norm() < 1e-6;
  std::cout << "shapemap " << shapemap::kVersion << (as_expected ? ": ok" : ": wrong returns") << '\n';
  return as_expected ? 0 : 1;
}
