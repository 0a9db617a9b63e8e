// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/scan/scan.hpp"
#include "shapemap/shape/shape.hpp"

/// Rooms are made of straight walls, and scanned from known poses.
namespace shapemap::test {

struct Wall {
  Point2 start_m;
  Point2 end_m;
};

using World = std::vector<Wall>;

inline void add_polygon(World& world, const std::vector<Point2>& corners) {
  for (std::size_t i = 0; i < corners.size(); ++i) world.push_back({corners[i], corners[(i + 1) % corners.size()]});
}

/// Adds a box of the given half lengths, turned about its centre.
inline void add_box(World& world, const Pose2& world_from_box, double half_x_m, double half_y_m) {
  add_polygon(world, {world_from_box * Point2(-half_x_m, -half_y_m), world_from_box * Point2(half_x_m, -half_y_m),
                      world_from_box * Point2(half_x_m, half_y_m), world_from_box * Point2(-half_x_m, half_y_m)});
}

/// Builds a room without symmetry, about 8 m by 6 m, around the origin.
inline World uneven_room() {
  World world;
  add_polygon(world, {{-4.0, -3.0},
                      {1.0, -3.0},
                      {1.0, -2.2},
                      {4.0, -2.2},
                      {4.0, 1.0},
                      {3.2, 3.0},
                      {-1.5, 3.0},
                      {-1.5, 2.0},
                      {-2.6, 2.0},
                      {-2.6, 3.0},
                      {-4.0, 3.0}});
  return world;
}

/// Builds the room with boxes strewn along a ring about its middle, which stays free for the robot.
inline World cluttered_room(unsigned seed, int num_boxes = 8) {
  World world = uneven_room();
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < num_boxes; ++i) {
    const double bearing_rad = 2 * kPi * (i + 0.6 * unit(rng)) / num_boxes;
    const double distance_m = 1.7 + 0.7 * unit(rng);
    const Point2 centre_m = rotate({distance_m, 0.0}, bearing_rad);
    const double half_x_m = 0.12 + 0.2 * unit(rng);
    const double half_y_m = 0.12 + 0.2 * unit(rng);
    add_box(world, {centre_m.x(), centre_m.y(), kPi * unit(rng)}, half_x_m, half_y_m);
  }
  return world;
}

/// Returns the distance from `from_m` along a direction to the first wall; infinity when there is none.
inline double cast_ray_m(const World& world, const Point2& from_m, double angle_rad) {
  const Point2 d(std::cos(angle_rad), std::sin(angle_rad));
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Wall& wall : world) {
    const Point2 along = wall.end_m - wall.start_m;
    const Point2 to = wall.start_m - from_m;
    const double cross = d.x() * along.y() - d.y() * along.x();
    if (std::abs(cross) < 1e-12) continue;
    const double range_m = (to.x() * along.y() - to.y() * along.x()) / cross;
    const double share = (to.x() * d.y() - to.y() * d.x()) / cross;
    if (range_m > 0.0 && share >= 0.0 && share <= 1.0) nearest_m = std::min(nearest_m, range_m);
  }
  return nearest_m;
}

inline double distance_to_walls_m(const World& world, const Point2& p_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const Wall& wall : world) nearest_m = std::min(nearest_m, LineSegment{wall.start_m, wall.end_m}.distance_m(p_m));
  return nearest_m;
}

/// The sensor that takes the scans.
struct Scanner {
  int num_beams = 720;        ///< beams of one sweep
  double view_rad = 2 * kPi;  ///< field of view of one sweep
  double noise_m = 0.0;       ///< standard deviation of a range
  int num_sweeps = 1;         ///< spread evenly over a full turn
  double max_range_m = 20.0;
};

/// Scans the world from `world_from_robot`.
inline Scan scan_of(const World& world, const Pose2& world_from_robot, const Scanner& scanner, std::mt19937& rng) {
  std::normal_distribution<double> noise(0.0, 1.0);
  Scan scan;
  for (int s = 0; s < scanner.num_sweeps; ++s) {
    Sweep sweep;
    sweep.angle_step_rad = scanner.view_rad / scanner.num_beams;
    sweep.first_angle_rad = -scanner.view_rad / 2 + sweep.angle_step_rad / 2;
    sweep.max_range_m = scanner.max_range_m;
    sweep.nominal_heading_rad = 2 * kPi * s / scanner.num_sweeps;
    for (int b = 0; b < scanner.num_beams; ++b) {
      const double angle_rad =
          world_from_robot.theta_rad + sweep.nominal_heading_rad + sweep.beam_angle_rad(static_cast<std::size_t>(b));
      const double range_m = cast_ray_m(world, world_from_robot.translation(), angle_rad);
      const double read_m = std::min(range_m + scanner.noise_m * noise(rng), scanner.max_range_m);
      sweep.ranges_m.push_back(static_cast<float>(read_m));
    }
    scan.sweeps.push_back(std::move(sweep));
  }
  return scan;
}

inline Scan scan_of(const World& world, const Pose2& world_from_robot, const Scanner& scanner = {}) {
  std::mt19937 rng(1);
  return scan_of(world, world_from_robot, scanner, rng);
}

/// The tests of the paper's method depend on these options, whatever the defaults are.
inline MappingOptions paper_options() {
  MappingOptions options;
  options.run.method = Method::kPaper;
  options.polylines.run_gap_m = 0.20;
  options.polylines.run_gap_beams = 5.0;
  options.polylines.simplify_tolerance_m = 0.05;
  options.polylines.em_sigma_m = 0.02;
  options.polylines.em_max_iterations = 20;
  options.polylines.min_support = 2;
  options.polylines.merge_angle_rad = 10 * kDegree;
  options.shape.points = ShapePoints::kResampled;
  options.shape.spacing_m = 0.05;
  options.shape.min_points = 10;
  options.paper.histogram = {0.50, HistogramNorm::kMaximum};
  options.paper.similarity = {10 * kDegree, 0.25, 2};
  options.paper.rotation = {2 * kDegree, 1 * kDegree};
  options.paper.lcs.target = LcsTarget::kPerScan;
  options.paper.filters = {10 * kDegree, 0.30, 2.0, 0.20};
  options.paper.overlap = {0.40, 10 * kDegree, OverlapRule::kNearest};
  options.paper.icp = {20, IcpGate::kFactor, 3.0, false};
  options.paper.trust = {1, 0.10};
  options.paper.target.target_scans = 3;
  return options;
}

inline Shape shape_of(const Scan& scan, const MappingOptions& options) {
  return shapemap::shape_of(scan, options.returns, options.polylines, options.shape);
}

/// Returns the shape of a scan of the world, in the robot's frame.
inline Shape shape_from(const World& world, const Pose2& world_from_robot, const Scanner& scanner = {},
                        unsigned seed = 1) {
  std::mt19937 rng(seed);
  return shape_of(scan_of(world, world_from_robot, scanner, rng), paper_options());
}

}  // namespace shapemap::test
