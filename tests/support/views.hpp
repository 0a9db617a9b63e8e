// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <limits>
#include <random>

#include "shapemap/shape/scan_view.hpp"
#include "support/synthetic_world.hpp"

/// These places are hard to match, and have views of scans of them.
namespace shapemap::test {

/// Builds two parallel walls along x, too long to see their ends.
inline World bare_corridor(double half_width_m = 1.2) {
  return {{{-60.0, -half_width_m}, {60.0, -half_width_m}}, {{60.0, half_width_m}, {-60.0, half_width_m}}};
}

/// Builds a circle about the origin.
inline World round_room(double radius_m = 3.0) {
  World world;
  std::vector<Point2> corners;
  for (int k = 0; k < 90; ++k) corners.push_back(rotate({radius_m, 0.0}, 4.0 * k * kDegree));
  add_polygon(world, corners);
  return world;
}

/// Builds a polygon of 7 to 12 corners, 2 to 6 m away from the origin, with boxes in it; no two seeds have anything in
/// common.
inline World strange_place(unsigned seed) {
  World world;
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const int num_corners = 7 + static_cast<int>(6.0 * unit(rng));
  std::vector<Point2> corners;
  for (int k = 0; k < num_corners; ++k) {
    corners.push_back(rotate({2.0 + 4.0 * unit(rng), 0.0}, 2 * kPi * (k + 0.7 * unit(rng)) / num_corners));
  }
  add_polygon(world, corners);
  for (int k = 0; k < 4; ++k) {
    const Point2 centre_m = rotate({1.2 + unit(rng), 0.0}, kPi / 2 * (k + 0.7 * unit(rng)));
    add_box(world, {centre_m.x(), centre_m.y(), kPi * unit(rng)}, 0.1 + 0.2 * unit(rng), 0.1 + 0.2 * unit(rng));
  }
  return world;
}

/// Most robots have such a laser: half a circle in steps of a degree.
inline Scanner half_circle() {
  Scanner scanner;
  scanner.num_beams = 181;
  scanner.view_rad = 181 * kDegree;
  scanner.noise_m = 0.01;
  return scanner;
}

/// This laser sees all around in steps of a degree.
inline Scanner full_circle() {
  Scanner scanner;
  scanner.num_beams = 360;
  scanner.noise_m = 0.01;
  return scanner;
}

inline ScanView view_of(const Scan& scan) { return shapemap::view_of(scan, {}, {}, {}, {}); }

inline ScanView view_from(const World& world, const Pose2& world_from_robot, const Scanner& scanner = full_circle(),
                          unsigned seed = 1) {
  std::mt19937 rng(seed);
  return view_of(scan_of(world, world_from_robot, scanner, rng));
}

/// Turns the laser of a standing robot by `angle_rad`: the scan has exactly the same points, turned.
inline Scan turned(Scan scan, double angle_rad) {
  for (Sweep& sweep : scan.sweeps) sweep.nominal_heading_rad += angle_rad;
  return scan;
}

/// Returns a scan with no returns at all.
inline Scan blind_scan(int num_beams = 181) {
  Scan scan = scan_of(uneven_room(), {}, {num_beams, kPi, 0.0, 1, 20.0});
  for (float& range_m : scan.sweeps[0].ranges_m) range_m = std::numeric_limits<float>::quiet_NaN();
  return scan;
}

}  // namespace shapemap::test
