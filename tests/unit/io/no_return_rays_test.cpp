// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shapemap/grid/occupancy_grid.hpp"
#include "support/placed_world.hpp"

/// Beams without a return have crossed free space.
namespace shapemap {
namespace {

using test::PlacedLog;

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// The three beams look right, ahead and left.
Scan three_beams(float right_m, float ahead_m, float left_m, double max_range_m = 8.0) {
  Sweep sweep;
  sweep.ranges_m = {right_m, ahead_m, left_m};
  sweep.first_angle_rad = -kPi / 2;
  sweep.angle_step_rad = kPi / 2;
  sweep.max_range_m = max_range_m;
  Scan scan;
  scan.sweeps.push_back(sweep);
  return scan;
}

OccupancyGrid drawn(const PlacedLog& walk, double clear_no_return_m) {
  OccupancyGridOptions options;
  options.resolution_m = 0.1;
  options.clear_no_return_m = clear_no_return_m;
  return build_occupancy_grid(walk.log.scans, walk.placed, {}, options);
}

PlacedLog one_scan(const Scan& scan) {
  PlacedLog walk;
  walk.add(scan, {0.05, 0.05, 0.0});
  return walk;
}

bool is_inside(const OccupancyGrid& map, double x_m, double y_m) {
  const Eigen::Vector2i pixel = map.pixel_at({x_m, y_m});
  return 0 <= pixel.x() && pixel.x() < map.width_cells && 0 <= pixel.y() && pixel.y() < map.height_cells;
}

int grey_at(const OccupancyGrid& map, double x_m, double y_m) {
  const Eigen::Vector2i pixel = map.pixel_at({x_m, y_m});
  return map.grey.at(static_cast<std::size_t>(pixel.y() * map.width_cells + pixel.x()));
}

bool is_free(const OccupancyGrid& map, double x_m, double y_m) {
  return is_inside(map, x_m, y_m) && grey_at(map, x_m, y_m) > 129;
}
bool is_occupied(const OccupancyGrid& map, double x_m, double y_m) { return grey_at(map, x_m, y_m) < 126; }

TEST(NoReturnRays, AreNotDrawnUnlessAskedFor) {
  const PlacedLog walk = one_scan(three_beams(1.0F, kNothing, 1.0F));
  EXPECT_FALSE(is_free(drawn(walk, 0.0), 0.45, 0.05));
  EXPECT_TRUE(is_free(drawn(walk, 3.0), 0.45, 0.05));
}

TEST(NoReturnRays, ClearAsFarAsAskedForAndTheLaserSees) {
  const PlacedLog walk = one_scan(three_beams(1.0F, kNothing, 1.0F));
  const OccupancyGrid three = drawn(walk, 3.0);
  EXPECT_TRUE(is_free(three, 2.95, 0.05));
  EXPECT_FALSE(is_free(three, 3.15, 0.05));
  const OccupancyGrid all = drawn(walk, 500.0);
  EXPECT_TRUE(is_free(all, 7.95, 0.05));
  EXPECT_FALSE(is_free(all, 8.15, 0.05));
  EXPECT_EQ(all.height_cells, drawn(walk, 0.0).height_cells);
  EXPECT_EQ(all.num_returns, 2U) << "they are no returns";
}

TEST(NoReturnRays, AreThoseThatHitNothingNotThoseThatSayNothing) {
  for (const float nothing : {kNothing, std::numeric_limits<float>::infinity(), 8.0F, 9.5F}) {
    EXPECT_TRUE(is_free(drawn(one_scan(three_beams(1.0F, nothing, 1.0F)), 3.0), 1.05, 0.05)) << nothing;
  }
  Scan too_near = three_beams(1.0F, 0.05F, 1.0F);
  too_near.sweeps[0].min_range_m = 0.1;
  EXPECT_FALSE(is_free(drawn(one_scan(too_near), 3.0), 1.05, 0.05));
  for (const float odd : {0.0F, -1.0F, -std::numeric_limits<float>::infinity()}) {
    EXPECT_FALSE(is_free(drawn(one_scan(three_beams(1.0F, odd, 1.0F)), 3.0), 1.05, 0.05)) << odd;
  }
  const Scan no_maximum = three_beams(1.0F, 5000.0F, 1.0F, 0.0);
  EXPECT_FALSE(is_free(drawn(one_scan(no_maximum), 3.0), 1.05, 0.05)) << "damage";
}

TEST(NoReturnRays, StopAtWhatIsKnownToBeAWall) {
  PlacedLog walk = one_scan(three_beams(1.0F, 2.0F, 1.0F));
  walk.add(three_beams(1.0F, kNothing, 1.0F), {0.05, 0.05, 0.0});
  const OccupancyGrid map = drawn(walk, 5.0);
  EXPECT_TRUE(is_occupied(map, 2.05, 0.05));
  EXPECT_FALSE(is_free(map, 2.55, 0.05)) << "behind the wall";
  EXPECT_EQ(map.grey, drawn(walk, 0.0).grey) << "all that it crosses is known already";
}

TEST(NoReturnRays, DoNotSlipThroughACornerOfAWall) {
  PlacedLog walk;
  // Returns lie in the cells (1, 0) and (0, 1), and a beam passes the corner that they share, to the cells (1, 1) and
  // on.
  walk.add(three_beams(kNothing, 0.1F, 0.1F), {0.05, 0.05, 0.0});
  walk.log.scans[0].sweeps[0].ranges_m[0] = 1.0F;
  walk.add(three_beams(1.0F, kNothing, 1.0F), {0.05, 0.05, 45 * kDegree});
  EXPECT_FALSE(is_free(drawn(walk, 3.0), 0.55, 0.55));
}

TEST(NoReturnRays, OfScansThatContradictTheMapAreNotDrawn) {
  PlacedLog walk = one_scan(three_beams(1.0F, 2.0F, 1.0F));
  walk.add(three_beams(1.0F, kNothing, 1.0F), {0.05, 0.05, kPi});
  EXPECT_TRUE(is_free(drawn(walk, 3.0), -1.05, 0.05));
  walk.placed[1].consistency.contradicts_map = true;
  EXPECT_FALSE(is_free(drawn(walk, 3.0), -1.05, 0.05));
}

TEST(NoReturnRays, MakeThePictureNoLargerThanWhatTheyClear) {
  PlacedLog walk = one_scan(three_beams(1.0F, 2.0F, 1.0F));
  walk.add(three_beams(1.0F, kNothing, 1.0F), {0.05, 0.05, 0.0});
  EXPECT_EQ(drawn(walk, 7.0).width_cells, drawn(walk, 0.0).width_cells);
  walk.add(three_beams(1.0F, kNothing, 1.0F), {0.05, 0.05, kPi});
  EXPECT_EQ(drawn(walk, 7.0).width_cells, drawn(walk, 0.0).width_cells + 69) << "the last of 70 cells is not crossed";
}

TEST(NoReturnRays, OfALaserThatIsTiltedTooMuchAreNone) {
  PlacedLog walk = one_scan(three_beams(1.0F, 2.0F, 1.0F));
  walk.log.scans[0].sweeps.push_back(three_beams(kNothing, kNothing, kNothing).sweeps[0]);
  walk.log.scans[0].sweeps[1].nominal_heading_rad = kPi;
  walk.placed[0].robot_from_sweep.emplace_back();
  EXPECT_TRUE(is_free(drawn(walk, 3.0), -1.05, 0.05));
  walk.log.scans[0].sweeps[1].robot_from_sensor.pitch_rad = 60 * kDegree;
  EXPECT_FALSE(is_free(drawn(walk, 3.0), -1.05, 0.05));
}

}  // namespace
}  // namespace shapemap
