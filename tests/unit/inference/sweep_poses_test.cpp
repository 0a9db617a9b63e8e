// SPDX-License-Identifier: GPL-3.0-or-later
// These tests map scans of several sweeps, from the log to the result.
#include <gmock/gmock.h>

#include "shapemap/mapper/map_log.hpp"
#include "support/matchers.hpp"
#include "support/sweeps_at_stops.hpp"

namespace shapemap {
namespace {

MapResult mapped(const Log& log, int rounds) {
  MappingOptions options;
  options.run.threads = 1;
  options.robust.sweep_refinement.rounds = rounds;
  options.robust.edge_verification.doubt_below = 0.0;
  MappingEvents nobody;
  return map_log(log, options, nobody);
}

TEST(SweepPoses, AreInTheResultAndBetterThanNominal) {
  const test::Stops stops = test::stops_on_ring(8, 1.2, 3, 0.02, 2 * kDegree);
  double rms_rad[2] = {};
  for (const int rounds : {0, 10}) {
    const MapResult result = mapped(stops.log, rounds);
    ASSERT_EQ(result.placed().size(), stops.truth.size());
    std::vector<Pose2> poses;
    std::vector<std::vector<Pose2>> corrections;
    for (const PlacedScan& placed : result.placed()) {
      poses.push_back(placed.map_from_robot);
      corrections.push_back(placed.robot_from_sweep);
      ASSERT_EQ(corrections.back().size(), static_cast<std::size_t>(test::kTurns));
    }
    rms_rad[rounds > 0] = test::heading_rms_rad(stops, poses, corrections);
  }
  ASSERT_GT(rms_rad[0], 0.9 * kDegree);
  EXPECT_LT(rms_rad[1], 0.4 * rms_rad[0]);
}

TEST(SweepPoses, DoNotMatterWhereEachScanHasOneSweep) {
  Log log;
  std::mt19937 rng(4);
  for (const Pose2& pose : test::ring_walk(6, 2)) {
    log.scans.push_back(test::scan_of(test::ring_world(1), pose, test::full_circle(), rng));
  }
  const MapResult without = mapped(log, 0);
  const MapResult with = mapped(log, 10);
  ASSERT_EQ(with.placed().size(), log.scans.size());
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    EXPECT_THAT(with.placed()[i].map_from_robot, test::HasSameBits(without.placed()[i].map_from_robot));
  }
}

}  // namespace
}  // namespace shapemap
