// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shapemap/grid/occupancy_grid.hpp"
#include "support/placed_world.hpp"

/// These tests tell which returns a picture shows, and which not.
namespace shapemap {
namespace {

using test::add_box;
using test::PlacedLog;
using test::Scanner;
using test::walk_through;
using test::World;

OccupancyGrid drawn(const PlacedLog& walk, bool draw_all = false) {
  OccupancyGridOptions options;
  options.resolution_m = 0.1;
  options.draw_all = draw_all;
  return build_occupancy_grid(walk.log.scans, walk.placed, {}, options);
}

double width_m(const OccupancyGrid& map) { return map.width_cells * map.resolution_m; }
double height_m(const OccupancyGrid& map) { return map.height_cells * map.resolution_m; }

/// The log of these lasers states no maximum range.
Scanner far_scanner(int num_beams = 180) {
  Scanner scanner;
  scanner.num_beams = num_beams;
  scanner.max_range_m = 990.0;
  return scanner;
}

float& reading(PlacedLog& walk, std::size_t scan, std::size_t beam) {
  return walk.log.scans.at(scan).sweeps.at(0).ranges_m.at(beam);
}

World box_room(double half_x_m, double half_y_m) {
  World world;
  add_box(world, {}, half_x_m, half_y_m);
  return world;
}

PlacedLog office_walk(int num_scans) {
  return walk_through(test::cluttered_room(3), {{-0.8, 0.0, 0.3}, {0.8, 0.1}, num_scans}, far_scanner());
}

void expect_whole(const PlacedLog& walk) {
  const OccupancyGrid map = drawn(walk);
  const OccupancyGrid all = drawn(walk, true);
  EXPECT_EQ(map.num_outside, 0U);
  EXPECT_GT(map.num_returns, 0U);
  EXPECT_EQ(map.width_cells, all.width_cells);
  EXPECT_EQ(map.grey, all.grey);
}

TEST(MapExtent, HoldsAllOfARoom) { expect_whole(office_walk(20)); }

TEST(MapExtent, OneFalseReadingMakesNoPictureOf18000Pixels) {
  PlacedLog walk = office_walk(20);
  const OccupancyGrid before = drawn(walk);
  for (const float far_m : {40.0F, 900.0F}) {
    reading(walk, 7, 31) = far_m;
    const OccupancyGrid map = drawn(walk);
    EXPECT_EQ(map.width_cells, before.width_cells) << far_m;
    EXPECT_EQ(map.height_cells, before.height_cells) << far_m;
    EXPECT_EQ(map.origin_m, before.origin_m) << far_m;
    EXPECT_EQ(map.num_outside, 1U) << far_m;
    EXPECT_EQ(map.num_returns, 20U * 180U) << far_m;
    EXPECT_GT(width_m(drawn(walk, true)) + height_m(drawn(walk, true)), 0.7 * far_m);
    EXPECT_EQ(drawn(walk, true).num_outside, 0U);
  }
}

TEST(MapExtent, ABeamThatEndsOutsideClearsUpToTheRim) {
  PlacedLog walk = walk_through(box_room(5.0, 4.0), {{-2.05, 0.05, 0.0}, {1.95, 0.05}, 9}, far_scanner());
  for (std::size_t i = 0; i < 9; ++i) {
    if (i != 4) reading(walk, i, 90) = std::numeric_limits<float>::quiet_NaN();
  }
  reading(walk, 4, 90) = 900.0F;
  const OccupancyGrid map = drawn(walk);
  EXPECT_EQ(map.num_outside, 1U);
  const double angle_rad = walk.log.scans[4].sweeps[0].beam_angle_rad(90);
  for (double along_m = 0.5; along_m < 5.3; along_m += 0.2) {
    const Eigen::Vector2i pixel = map.pixel_at(Point2(-0.05, 0.05) + rotate({along_m, 0.0}, angle_rad));
    EXPECT_GT(map.grey.at(static_cast<std::size_t>(pixel.y() * map.width_cells + pixel.x())), 129) << along_m;
  }
}

TEST(MapExtent, FalseReadingsInEachScanAreLeftOutWhereverTheyEnd) {
  std::mt19937 rng(5);
  std::uniform_int_distribution<std::size_t> any_beam(0, 179);
  PlacedLog anywhere = office_walk(200);
  const OccupancyGrid before = drawn(anywhere);
  for (std::size_t i = 0; i < 200; ++i) reading(anywhere, i, any_beam(rng)) = 900.0F;
  PlacedLog same_beam = office_walk(200);
  for (std::size_t i = 0; i < 200; ++i) reading(same_beam, i, 17) = 900.0F;
  for (const PlacedLog* walk : {&anywhere, &same_beam}) {
    const OccupancyGrid map = drawn(*walk);
    EXPECT_EQ(map.num_outside, 200U);
    EXPECT_EQ(map.width_cells, before.width_cells);
    EXPECT_EQ(map.height_cells, before.height_cells);
  }
}

TEST(MapExtent, ASingleScanIsDrawnWithAllThatItSaw) {
  PlacedLog one = office_walk(1);
  expect_whole(one);
  reading(one, 0, 31) = 80.0F;
  expect_whole(one);
}

TEST(MapExtent, AFewBeamsThroughAWindowAreLeftOutAndAHallBehindADoorIsNot) {
  World window = box_room(5.0, 4.0);
  window[1] = {{5.0, -4.0}, {5.0, -0.15}};  // the wall on the right has a gap
  window.push_back({{5.0, 0.15}, {5.0, 4.0}});
  World hall = window;
  window.push_back({{120.0, -40.0}, {120.0, 40.0}});
  const OccupancyGrid small = drawn(walk_through(window, {{-3.0, 2.0, 0.0}, {-1.0, 0.5}, 12}, far_scanner()));
  EXPECT_LT(width_m(small), 15.0);
  EXPECT_GT(small.num_outside, 0U);
  EXPECT_LT(small.num_outside, small.num_returns / 20);
  add_box(hall, {17.1, 0.0, 0.0}, 12.0, 10.0);
  hall[hall.size() - 1] = {{5.1, 10.0}, {5.1, 0.15}};  // open towards the room
  hall.push_back({{5.1, -0.15}, {5.1, -10.0}});
  expect_whole(walk_through(hall, {{-3.0, 2.0, 0.0}, {4.5, 0.0}, 12}, far_scanner(360)));
}

TEST(MapExtent, OfALongCorridorNothingIsCutOff) {
  for (const double turn_rad : {0.0, 40 * kDegree}) {
    World corridor;
    add_box(corridor, {rotate({38.0, 0.0}, turn_rad).x(), rotate({38.0, 0.0}, turn_rad).y(), turn_rad}, 40.0, 1.0);
    const Point2 last_m = rotate({3.0, 0.2}, turn_rad);
    expect_whole(walk_through(corridor, {{0.0, 0.0, turn_rad}, last_m, 10}, far_scanner(360)));
  }
}

TEST(MapExtent, TwoRoomsFarApartAreBothDrawn) {
  World world = box_room(4.0, 3.0);
  add_box(world, {300.0, 120.0, 0.4}, 4.0, 3.0);
  PlacedLog walk = walk_through(world, {{-1.0, 0.0, 0.0}, {1.0, 0.0}, 30}, far_scanner());
  std::mt19937 rng(1);
  add_walk(walk, world, {{300.0, 120.0, 0.0}, {301.0, 120.0}, 3}, far_scanner(), rng);
  expect_whole(walk);
}

TEST(MapExtent, OfSparseScansOutdoorsNothingIsCutOff) {
  World trees;
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> place(-30.0, 30.0);
  for (int i = 0; i < 60; ++i) add_box(trees, {100.0 + 4.0 * place(rng), place(rng), 0.0}, 0.2, 0.2);
  Scanner scanner = far_scanner(90);
  scanner.max_range_m = 40.0;
  expect_whole(walk_through(trees, {{0.0, 0.0, 0.0}, {200.0, 0.0}, 60}, scanner));
  expect_whole(walk_through(trees, {{0.0, 0.0, 0.0}, {200.0, 0.0}, 4}, scanner));
}

TEST(MapExtent, ANoisySensorKeepsItsRoom) {
  Scanner scanner = far_scanner();
  scanner.noise_m = 0.3;
  expect_whole(walk_through(box_room(5.0, 4.0), {{-2.0, 0.0, 0.0}, {2.0, 0.0}, 20}, scanner));
  PlacedLog spoilt = walk_through(box_room(5.0, 4.0), {{-2.0, 0.0, 0.0}, {2.0, 0.0}, 50}, scanner);
  std::mt19937 rng(2);
  std::uniform_real_distribution<float> anywhere_m(0.2F, 200.0F);
  for (std::size_t i = 0; i < 50; ++i) reading(spoilt, i, 3 * i) = anywhere_m(rng);
  EXPECT_LT(width_m(drawn(spoilt)) * height_m(drawn(spoilt)), 5 * 10 * 8);
}

TEST(MapExtent, AStraightWayHasAnExtent) {
  PlacedLog walk = walk_through(box_room(5.0, 4.0), {{-4.0, 0.0, 0.0}, {4.0, 0.0}, 20}, far_scanner(3));
  expect_whole(walk);
}

TEST(MapExtent, WhatContradictsTheMapIsNoSupportForFarReturns) {
  PlacedLog walk = office_walk(40);
  const OccupancyGrid before = drawn(walk);
  for (std::size_t i = 30; i < 33; ++i) {
    for (std::size_t beam = 50; beam < 110; ++beam) reading(walk, i, beam) = 300.0F;
    walk.placed[i].consistency.contradicts_map = true;
  }
  const OccupancyGrid map = drawn(walk);
  EXPECT_EQ(map.num_outside, 180U);
  EXPECT_EQ(map.width_cells, before.width_cells);
}

}  // namespace
}  // namespace shapemap
