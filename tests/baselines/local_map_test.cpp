// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_map.hpp"

#include <gmock/gmock.h>

#include "support/matchers.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap::baselines {
namespace {

using ::testing::SizeIs;

/// A beam that runs ahead from the robot.
std::vector<Beam> ahead(double range_m) { return {{{0.0, 0.0}, {range_m, 0.0}}}; }

TEST(LocalMap, CountsEndsAmongTheBeamsThatCameSoFar) {
  LocalMap map(10, 0.1);
  EXPECT_THAT(map.occupied_spots({0.0, 0.0}, 5.0), SizeIs(0));
  for (int i = 0; i < 3; ++i) map.add({}, ahead(2.02));
  map.add({}, ahead(3.05));
  // Cells begin at the lowest corner of what is seen: 2.02 lies in that from 2.0 to 2.1.
  const std::vector<OccupiedSpot> spots = map.occupied_spots({0.0, 0.0}, 5.0);
  ASSERT_THAT(spots, SizeIs(2));
  EXPECT_THAT(spots[0].p_m, test::IsNearPoint(Point2(2.02, 0.0), 1e-5));
  EXPECT_NEAR(spots[0].occupancy, 3.0 / 4.0, 1e-12);
  EXPECT_THAT(spots[1].p_m, test::IsNearPoint(Point2(3.05, 0.0), 1e-5));
  EXPECT_NEAR(spots[1].occupancy, 1.0, 1e-12);
}

TEST(LocalMap, PutsScansWhereTheyWereTaken) {
  LocalMap map(10, 0.1);
  map.add({1.0, 2.0, kPi / 2}, ahead(3.0));
  const std::vector<OccupiedSpot> spots = map.occupied_spots({1.0, 2.0}, 5.0);
  ASSERT_THAT(spots, SizeIs(1));
  EXPECT_THAT(spots[0].p_m, test::IsNearPoint(Point2(1.0, 5.0), 1e-5));
}

TEST(LocalMap, ForgetsOldScansAndLeavesOutFarOnes) {
  LocalMap map(2, 0.1);
  map.add({}, ahead(1.0));
  map.add({0.0, 1.0, 0.0}, ahead(2.0));
  map.add({0.0, 50.0, 0.0}, ahead(3.0));
  map.add({}, {});  // a blind scan takes nobody's place
  EXPECT_THAT(map.occupied_spots({0.0, 0.0}, 100.0), SizeIs(2));
  const std::vector<OccupiedSpot> near = map.occupied_spots({0.0, 0.0}, 10.0);
  ASSERT_THAT(near, SizeIs(1));
  EXPECT_THAT(near[0].p_m, test::IsNearPoint(Point2(2.0, 1.0), 1e-5));
}

TEST(Beams, StartAtTheLaserAndEndOnWalls) {
  const test::World world = test::uneven_room();
  const Pose2 pose{0.5, -0.4, 0.3};
  test::Scanner scanner;
  scanner.num_sweeps = 4;
  scanner.view_rad = kPi / 2;
  scanner.num_beams = 90;
  const Scan scan = test::scan_of(world, pose, scanner);
  const std::vector<Beam> beams = beams_of(scan, {}, 20.0);
  ASSERT_THAT(beams, SizeIs(360));
  for (const Beam& beam : beams) {
    EXPECT_THAT(beam.from_m, test::IsNearPoint(Point2(0.0, 0.0), 1e-9));
    EXPECT_LT(test::distance_to_walls_m(world, pose * beam.to_m), 1e-5);
  }
  const std::vector<Beam> shorter = beams_of(scan, {}, 3.0);
  EXPECT_LT(shorter.size(), beams.size());
  for (const Beam& beam : shorter) EXPECT_LE(beam.to_m.norm(), 3.0 + 1e-9);
}

}  // namespace
}  // namespace shapemap::baselines
