// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/grid/wall_direction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/matchers.hpp"
#include "support/placed_world.hpp"

namespace shapemap {
namespace {

using test::add_box;
using test::add_polygon;
using test::PlacedLog;
using test::Scanner;
using test::walk_through;
using test::World;

Scanner noisy_scanner(double noise_m = 0.01) {
  Scanner scanner;
  scanner.num_beams = 360;
  scanner.noise_m = noise_m;
  return scanner;
}

/// Walks through a world that is turned by `turn_rad`.
PlacedLog walk_in(const World& world, double turn_rad = 0.0, double noise_m = 0.01) {
  World turned;
  for (const test::Wall& wall : world) {
    turned.push_back({rotate(wall.start_m, turn_rad), rotate(wall.end_m, turn_rad)});
  }
  const Point2 first_m = rotate({-2.0, 0.1}, turn_rad);
  return walk_through(turned, {{first_m.x(), first_m.y(), 0.7}, rotate({2.0, -0.2}, turn_rad), 9},
                      noisy_scanner(noise_m));
}

WallDirection direction_in(const PlacedLog& walk) { return wall_direction(walk.log.scans, walk.placed, {}); }

World room_with_clutter() {
  World world;
  add_box(world, {}, 6.0, 4.0);
  for (int i = 0; i < 8; ++i) add_box(world, {-5.0 + 1.4 * i, i % 2 ? 2.5 : -2.5, 0.3 + 0.5 * i}, 0.4, 0.3);
  return world;
}

World polygon(int num_corners, double radius_m) {
  World world;
  std::vector<Point2> corners;
  for (int i = 0; i < num_corners; ++i) corners.push_back(rotate({radius_m, 0.0}, 2 * kPi * i / num_corners));
  add_polygon(world, corners);
  return world;
}

TEST(WallDirection, IsThatOfTheRoomWhateverStandsInIt) {
  for (const double turn_deg : {0.0, 3.0, 27.0, 44.0, -12.5, -44.0}) {
    const WallDirection found = direction_in(walk_in(room_with_clutter(), turn_deg * kDegree));
    EXPECT_NEAR(found.angle_rad / kDegree, turn_deg, 0.1);
    EXPECT_TRUE(found.is_dominant()) << found.share << " " << found.second_share;
  }
}

TEST(WallDirection, IsLeastOfTheFourTurns) {
  for (const double turn_deg : {46.0, 90.0, 134.0, -93.0}) {
    const WallDirection found = direction_in(walk_in(room_with_clutter(), turn_deg * kDegree));
    EXPECT_NEAR(found.angle_rad / kDegree, std::remainder(turn_deg, 90.0), 0.1);
    EXPECT_LE(std::abs(found.turn_rad()), 45.01 * kDegree);
  }
}

TEST(WallDirection, WithstandsNoise) {
  const WallDirection found = direction_in(walk_in(room_with_clutter(), 20 * kDegree, 0.05));
  EXPECT_NEAR(found.angle_rad / kDegree, 20.0, 0.3);
  EXPECT_TRUE(found.is_dominant()) << found.share << " " << found.second_share;
}

TEST(WallDirection, OfRoundRoomsOctagonsAndTrianglesIsNone) {
  for (const int num_corners : {3, 6, 8, 60}) {
    const WallDirection found = direction_in(walk_in(polygon(num_corners, 6.0), 10 * kDegree));
    EXPECT_FALSE(found.is_dominant()) << num_corners << ": " << found.share << " " << found.second_share;
    EXPECT_EQ(found.turn_rad(), 0.0);
  }
  EXPECT_TRUE(direction_in(walk_in(polygon(4, 6.0))).is_dominant()) << "a square has one";
}

TEST(WallDirection, OfTwoWingsIsThatOfTheLarger) {
  World world;
  add_box(world, {}, 12.0, 4.0);
  add_box(world, {0.0, 3.0, 30 * kDegree}, 0.8, 0.5);
  const WallDirection found = direction_in(walk_in(world, 5 * kDegree));
  EXPECT_NEAR(found.angle_rad / kDegree, 5.0, 0.2);
  EXPECT_LT(found.second_share, found.share / 2);
}

TEST(WallDirection, OfNothingIsNone) {
  PlacedLog walk = walk_in({});
  EXPECT_FALSE(direction_in(walk).is_dominant());
  EXPECT_FALSE(wall_direction(walk.log.scans, {}, {}).is_dominant());
}

TEST(WallDirection, TurnsAllComponentsAndNoMotion) {
  PlacedLog walk = walk_in(room_with_clutter(), 17 * kDegree);
  const PlacedLog other = walk_in(room_with_clutter(), -5 * kDegree);
  const PlacedLog round = walk_in(polygon(60, 6.0));
  std::vector<Component> components(3);
  std::vector<Scan> scans;
  for (const PlacedLog* part : std::vector<const PlacedLog*>{&walk, &other, &round}) {
    for (PlacedScan place : part->placed) {
      place.scan_index += scans.size() - place.scan_index;
      components[static_cast<std::size_t>(part == &other) + 2 * static_cast<std::size_t>(part == &round)]
          .scans.push_back(place);
      scans.push_back(part->log.scans[place.scan_index % 9]);
    }
  }
  const std::vector<Component> before = components;
  const std::vector<WallDirection> found = align_walls(scans, {}, components);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_NEAR(found[0].turn_rad() / kDegree, -17.0, 0.1);
  EXPECT_NEAR(found[1].turn_rad() / kDegree, 5.0, 0.1);
  EXPECT_EQ(found[2].turn_rad(), 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(wall_direction(scans, components[i].scans, {}).turn_rad(), 0.0, 1e-3);
    for (std::size_t k = 1; k < 9; ++k) {
      const auto motion = [&](const std::vector<PlacedScan>& placed) {
        return inverse(placed[k - 1].map_from_robot) * placed[k].map_from_robot;
      };
      EXPECT_THAT(motion(components[i].scans), test::IsNearPose(motion(before[i].scans), 1e-12, 1e-12));
    }
  }
  EXPECT_EQ(components[2].scans[4].map_from_robot, before[2].scans[4].map_from_robot);
}

}  // namespace
}  // namespace shapemap
