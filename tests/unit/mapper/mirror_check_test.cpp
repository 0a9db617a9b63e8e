// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/mirror_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "shapemap/core/angles.hpp"

namespace shapemap {
namespace {

struct Walk {
  std::vector<Scan> scans;
  std::vector<std::size_t> sessions;  ///< that of each scan
  std::vector<PlacedScan> placed;

  TurnComparison turns() const { return compare_turns(scans, sessions, placed); }
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
    walk.scans.push_back(scan);
    walk.sessions.push_back(0);
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
    const TurnComparison of_right = right.turns();
    EXPECT_GT(of_right.num_alike, 10U);
    EXPECT_FALSE(of_right.is_mirrored());
    const Walk mirrored = walk(4000, -1.0, 0.3 * turn_rad, turn_rad);
    EXPECT_TRUE(mirrored.turns().is_mirrored());
  }
}

TEST(MirrorCheck, SaysNothingOfHeadingsThatAreNoise) {
  const Walk noise = walk(2000, 0.0, 20 * kDegree, 20 * kDegree);
  EXPECT_FALSE(noise.turns().is_mirrored());
}

TEST(MirrorCheck, SaysNothingWithoutHeadingsOrWithFewTurns) {
  Walk some = walk(6, -1.0, 0.0, 20 * kDegree);
  EXPECT_FALSE(some.turns().is_mirrored());
  Walk none = walk(400, -1.0, 0.0, 20 * kDegree);
  for (Scan& scan : none.scans) scan.recorded_heading_rad.reset();
  EXPECT_EQ(none.turns().num_opposite, 0U);
}

TEST(MirrorCheck, ComparesNoTurnFromOneSessionToTheNext) {
  Walk apart = walk(400, -1.0, 0.0, 20 * kDegree);
  const std::size_t num_together = apart.turns().num_opposite;
  std::iota(apart.sessions.begin(), apart.sessions.end(), std::size_t{0});
  EXPECT_EQ(apart.turns().num_opposite, 0U) << "each scan is a session of its own";
  EXPECT_EQ(apart.turns().num_alike, 0U);
  for (std::size_t i = 0; i < apart.sessions.size(); ++i) apart.sessions[i] = i / 200;
  const std::size_t num_in_halves = apart.turns().num_opposite;
  EXPECT_LE(num_in_halves, num_together);
  EXPECT_GT(num_in_halves, num_together / 2) << "turns within a session count";
}

}  // namespace
}  // namespace shapemap
