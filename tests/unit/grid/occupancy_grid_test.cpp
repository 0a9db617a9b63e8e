// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/grid/occupancy_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shapemap/core/errors.hpp"

namespace shapemap {
namespace {

using testing::HasSubstr;

/// Makes a laser in the middle of the robot that looks forward with three beams: 90 deg right, ahead, 90 deg left.
Sweep three_beams(float right_m, float ahead_m, float left_m) {
  Sweep sweep;
  sweep.ranges_m = {right_m, ahead_m, left_m};
  sweep.first_angle_rad = -kPi / 2;
  sweep.angle_step_rad = kPi / 2;
  sweep.max_range_m = 10.0;
  return sweep;
}

std::vector<Scan> scans_of(const Sweep& sweep) { return {Scan{1.0, {sweep}, std::nullopt, std::nullopt}}; }

PlacedScan placed_at(const Pose2& map_from_robot, std::size_t index = 0) {
  return {index, 1.0, map_from_robot, {Pose2{}}};
}

OccupancyGrid map_of(const std::vector<Scan>& scans, const Pose2& map_from_robot, double resolution_m = 0.1) {
  return build_occupancy_grid(scans, {placed_at(map_from_robot)}, ReturnOptions{}, OccupancyGridOptions{resolution_m});
}

int grey_at(const OccupancyGrid& map, double x_m, double y_m) {
  const Eigen::Vector2i pixel = map.pixel_at({x_m, y_m});
  return map.grey.at(static_cast<std::size_t>(pixel.y() * map.width_cells + pixel.x()));
}

constexpr int kUnknownLow = 126;
constexpr int kUnknownHigh = 129;

bool is_unknown(int grey) { return kUnknownLow <= grey && grey <= kUnknownHigh; }

TEST(OccupancyGrid, NorthOfTheOriginIsTowardsRowZero) {
  OccupancyGrid map;
  map.resolution_m = 0.5;
  map.origin_m = {-1.0, -2.0};
  map.width_cells = 10;
  map.height_cells = 20;
  EXPECT_EQ(map.pixel_at({-0.9, -1.9}), Eigen::Vector2i(0, 19));
  EXPECT_EQ(map.pixel_at({-0.9, 7.9}), Eigen::Vector2i(0, 0));
  EXPECT_EQ(map.pixel_at({-1.1, -2.1}), Eigen::Vector2i(-1, 20));
}

TEST(OccupancyGrid, HitsAreDarkTheWayThereIsLightTheRestIsUnknown) {
  const OccupancyGrid map = map_of(scans_of(three_beams(1.0F, 2.0F, 3.0F)), {0.05, 0.05, 0.0});
  EXPECT_LT(grey_at(map, 2.05, 0.05), 60);
  EXPECT_LT(grey_at(map, 0.05, -0.95), 60);
  EXPECT_LT(grey_at(map, 0.05, 3.05), 60);
  for (const double along_m : {0.3, 1.0, 1.5}) EXPECT_GT(grey_at(map, along_m, 0.05), 150);
  EXPECT_GT(grey_at(map, 0.05, 1.5), 150);
  EXPECT_TRUE(is_unknown(grey_at(map, 2.25, 0.05))) << "behind the wall: " << grey_at(map, 2.25, 0.05);
  EXPECT_TRUE(is_unknown(grey_at(map, 1.0, 1.0)));
}

TEST(OccupancyGrid, ReadingsThatHitNothingAddNothing) {
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  for (const float reading : {nothing, 0.0F, -1.0F, 10.0F, std::numeric_limits<float>::infinity()}) {
    const OccupancyGrid with = map_of(scans_of(three_beams(1.0F, reading, 3.0F)), {});
    Sweep without = three_beams(1.0F, 1.0F, 3.0F);
    without.ranges_m[1] = nothing;
    EXPECT_EQ(with.grey, map_of(scans_of(without), {}).grey) << reading;
    EXPECT_EQ(with.width_cells, 9) << "one column and four cells of margin on either side, for " << reading;
  }
}

TEST(OccupancyGrid, SweepsStandWhereTheirCorrectionsPutThem) {
  std::vector<Scan> scans = scans_of(three_beams(NAN, 2.0F, NAN));
  scans[0].sweeps.push_back(three_beams(NAN, 2.0F, NAN));
  scans[0].sweeps[1].nominal_heading_rad = kPi / 2;
  PlacedScan place = placed_at({1.05, 1.05, kPi / 2});
  place.robot_from_sweep = {Pose2{}, Pose2{0.0, 0.5, 0.0}};
  const OccupancyGrid map = build_occupancy_grid(scans, {place}, ReturnOptions{}, OccupancyGridOptions{0.1});
  EXPECT_LT(grey_at(map, 1.05, 3.05), 60);   // ahead of a robot that faces north
  EXPECT_LT(grey_at(map, -1.45, 1.05), 60);  // the second sweep looks west, from half a metre to the robot's left
}

TEST(OccupancyGrid, ATiltedLaserIsProjectedAndABeyondLimitOneLeftOut) {
  Sweep tilted = three_beams(1.0F, 2.0F, 1.0F);
  tilted.robot_from_sensor.pitch_rad = 20 * kDegree;
  const OccupancyGrid map = map_of(scans_of(tilted), {0.05, 0.05, 0.0});
  EXPECT_LT(grey_at(map, 0.05 + 2.0 * std::cos(20 * kDegree), 0.05), 60);

  std::vector<Scan> scans = scans_of(three_beams(1.0F, 2.0F, 1.0F));
  const OccupancyGrid alone = map_of(scans, {});
  scans[0].sweeps.push_back(three_beams(3.0F, 3.0F, 3.0F));
  scans[0].sweeps[1].robot_from_sensor.pitch_rad = 60 * kDegree;
  PlacedScan place = placed_at({});
  place.robot_from_sweep = {Pose2{}, Pose2{}};
  EXPECT_EQ(build_occupancy_grid(scans, {place}, ReturnOptions{}, OccupancyGridOptions{0.1}).grey, alone.grey);
}

TEST(OccupancyGrid, AnUpsideDownLaserSeesItsLeftOnTheRight) {
  Sweep upside_down = three_beams(1.0F, 2.0F, 3.0F);
  upside_down.robot_from_sensor.roll_rad = kPi;
  const OccupancyGrid map = map_of(scans_of(upside_down), {0.05, 0.05, 0.0});
  EXPECT_LT(grey_at(map, 0.05, 1.05), 60);
  EXPECT_LT(grey_at(map, 0.05, -2.95), 60);
}

TEST(OccupancyGrid, IsCroppedToWhatWasSeenOnWholeCells) {
  const OccupancyGrid map = map_of(scans_of(three_beams(1.0F, 2.0F, 3.0F)), {100.05, -50.05, 0.0});
  EXPECT_EQ(map.width_cells, 21 + 8);
  EXPECT_EQ(map.height_cells, 41 + 8);
  EXPECT_NEAR(map.origin_m.x(), 100.0 - 0.4, 1e-9);
  EXPECT_NEAR(map.origin_m.y(), -51.1 - 0.4, 1e-9);
}

TEST(OccupancyGrid, RefusesWhatWouldNotFitAndSaysWhatHelps) {
  Sweep far = three_beams(900.0F, 900.0F, 900.0F);
  far.max_range_m = 0.0;
  try {
    map_of(scans_of(far), {}, 0.01);
    FAIL() << "a map of 1e10 cells was built";
  } catch (const OutputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("--resolution-m"));
  }
  EXPECT_NO_THROW(map_of(scans_of(three_beams(1.0F, 2.0F, 1.0F)), {}, 0.001));
}

TEST(OccupancyGrid, WithoutAPoseThereIsNoMap) {
  EXPECT_THROW(build_occupancy_grid(scans_of(three_beams(1, 1, 1)), {}, ReturnOptions{}, OccupancyGridOptions{}),
               OutputError);
}

/// All scans look ahead along x: two see free space up to 2 m, and one contradicts them.
struct Disputed {
  Disputed() {
    scans.push_back({1.0, {three_beams(1.0F, 2.0F, 1.0F)}, std::nullopt, std::nullopt});
    scans.push_back({2.0, {three_beams(1.0F, 3.0F, 0.5F)}, std::nullopt, std::nullopt});
    placed = {placed_at({0.05, 0.05, 0.0}, 0), placed_at({0.05, 0.05, 0.0}, 0), placed_at({0.05, 0.05, 0.0}, 1)};
  }
  OccupancyGrid map(Contradicting what) const {
    return build_occupancy_grid(scans, placed, {}, OccupancyGridOptions{0.1, what});
  }

  std::vector<Scan> scans;
  std::vector<PlacedScan> placed;
};

TEST(OccupancyGrid, WithoutContradictionsTheyAreDrawnAlike) {
  const Disputed disputed;
  EXPECT_EQ(disputed.map(Contradicting::kFillGaps).grey, disputed.map(Contradicting::kAsOthers).grey);
}

TEST(OccupancyGrid, WhatContradictsDrawsNothingInFreeSpaceOfOthersAndNothingBehindTheirWalls) {
  Disputed disputed;
  const OccupancyGrid as_others = disputed.map(Contradicting::kAsOthers);
  disputed.placed[2].consistency.contradicts_map = true;
  EXPECT_EQ(disputed.map(Contradicting::kAsOthers).grey, as_others.grey);
  const OccupancyGrid map = disputed.map(Contradicting::kFillGaps);
  EXPECT_LT(grey_at(as_others, 0.05, 0.55), grey_at(map, 0.05, 0.55)) << "free, whatever it says";
  EXPECT_LT(grey_at(map, 2.05, 0.05), 60) << "a wall, whatever it says";
  EXPECT_TRUE(is_unknown(grey_at(map, 2.55, 0.05))) << "behind that wall";
  EXPECT_TRUE(is_unknown(grey_at(map, 3.05, 0.05)));
  EXPECT_LT(grey_at(as_others, 3.05, 0.05), kUnknownLow);
}

TEST(OccupancyGrid, WhatContradictsDrawsWhereNoOtherScanSees) {
  Disputed disputed;
  disputed.placed = {placed_at({0.05, 0.05, 0.0}, 0), placed_at({0.05, 0.05, kPi}, 1)};
  disputed.placed[1].consistency.contradicts_map = true;
  const OccupancyGrid map = disputed.map(Contradicting::kFillGaps);
  EXPECT_GT(grey_at(map, -1.55, 0.05), kUnknownHigh);
  EXPECT_LT(grey_at(map, -2.95, 0.05), kUnknownLow);
  disputed.placed[0].consistency.contradicts_map = true;
  EXPECT_LT(grey_at(disputed.map(Contradicting::kFillGaps), 2.05, 0.05), kUnknownLow) << "even if all do";
}

TEST(OccupancyGrid, ComesOutTheSameEachTime) {
  const std::vector<Scan> scans = scans_of(three_beams(1.0F, 2.0F, 3.0F));
  const Pose2 pose{0.3, 0.7, 0.123};
  EXPECT_EQ(map_of(scans, pose, 0.013).grey, map_of(scans, pose, 0.013).grey);
}

}  // namespace
}  // namespace shapemap
