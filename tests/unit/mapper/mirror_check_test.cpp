// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/mirror_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shapemap/core/angles.hpp"

namespace shapemap {
namespace {

struct Walk {
  Log log;
  std::vector<PlacedScan> placed;
};

/// Returns a walk with random turns, and the headings that a robot with slipping wheels would record.
Walk walk(int num_scans, double handedness, double slip_rad, double turn_rad) {
  std::mt19937 rng(4);
  std::normal_distribution<double> noise(0.0, 1.0);
  Walk walk;
  double heading_rad = 0.0;
  double recorded_rad = 0.0;
  for (int i = 0; i < num_scans; ++i) {
    Scan scan;
    scan.recorded_heading_rad = wrap_angle(recorded_rad);
    walk.log.scans.push_back(scan);
    PlacedScan placed;
    placed.scan_index = static_cast<std::size_t>(i);
    placed.map_from_robot.theta_rad = wrap_angle(heading_rad);
    walk.placed.push_back(placed);
    const double step_rad = turn_rad * noise(rng);
    heading_rad += step_rad;
    recorded_rad += handedness * step_rad + slip_rad * noise(rng);
  }
  return walk;
}

TEST(MirrorCheck, TellsMirroredScansFromRightOnes) {
  for (const double turn_rad : {1 * kDegree, 10 * kDegree, 40 * kDegree}) {
    SCOPED_TRACE(turn_rad);
    const Walk right = walk(4000, 1.0, 0.3 * turn_rad, turn_rad);
    const TurnComparison of_right = compare_turns(right.log, right.placed);
    EXPECT_GT(of_right.num_alike, 10U);
    EXPECT_FALSE(of_right.is_mirrored());
    const Walk mirrored = walk(4000, -1.0, 0.3 * turn_rad, turn_rad);
    EXPECT_TRUE(compare_turns(mirrored.log, mirrored.placed).is_mirrored());
  }
}

TEST(MirrorCheck, SaysNothingOfHeadingsThatAreNoise) {
  const Walk noise = walk(2000, 0.0, 20 * kDegree, 20 * kDegree);
  EXPECT_FALSE(compare_turns(noise.log, noise.placed).is_mirrored());
}

TEST(MirrorCheck, SaysNothingWithoutHeadingsOrWithFewTurns) {
  Walk some = walk(6, -1.0, 0.0, 20 * kDegree);
  EXPECT_FALSE(compare_turns(some.log, some.placed).is_mirrored());
  Walk none = walk(400, -1.0, 0.0, 20 * kDegree);
  for (Scan& scan : none.log.scans) scan.recorded_heading_rad.reset();
  EXPECT_EQ(compare_turns(none.log, none.placed).num_opposite, 0U);
}

}  // namespace
}  // namespace shapemap
