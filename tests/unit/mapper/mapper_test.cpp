// SPDX-License-Identifier: GPL-3.0-or-later
// The whole robust method on simulated worlds: loops, several sessions, interruptions.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "shapemap/mapper/map_log.hpp"
#include "support/matchers.hpp"
#include "support/patience.hpp"
#include "support/ring_laps.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using ::testing::ElementsAre;

/// Returns options for a coarser search than by default.
MappingOptions quick() {
  MappingOptions options = test::quick_mapping();
  options.robust.loop_detection.likely_places = 4;
  return options;
}

MapResult mapped(const Log& log, const MappingOptions& options = quick()) {
  MappingEvents nobody;
  return map_log(log, options, nobody);
}

void add_walk(Log& log, const test::World& world, const std::vector<Pose2>& poses, unsigned seed = 7) {
  std::mt19937 rng(seed);
  if (!log.scans.empty()) log.starts.push_back(log.scans.size());
  for (const Pose2& pose : poses) log.scans.push_back(test::scan_of(world, pose, test::full_circle(), rng));
}

std::vector<Pose2> poses_of(const Component& component) {
  std::vector<Pose2> poses;
  for (const PlacedScan& placed : component.scans) poses.push_back(placed.map_from_robot);
  return poses;
}

std::vector<std::size_t> sizes_of(const MapResult& result) {
  std::vector<std::size_t> sizes;
  for (const Component& component : result.components) sizes.push_back(component.scans.size());
  return sizes;
}

/// Checks that each scan of the result is in exactly one component, with a finite pose and all its sweeps.
void expect_whole(const MapResult& result, const Log& log) {
  ASSERT_LE(result.scans.size(), log.scans.size());
  std::map<std::size_t, int> component_of;
  for (std::size_t f = 0; f < result.components.size(); ++f) {
    ASSERT_FALSE(result.components[f].scans.empty());
    EXPECT_THAT(result.components[f].scans[0].map_from_robot, test::IsNearPose(Pose2{}, 1e-12, 1e-12));
    for (const PlacedScan& placed : result.components[f].scans) {
      EXPECT_TRUE(component_of.emplace(placed.scan_index, static_cast<int>(f)).second) << "placed twice";
      const Pose2& pose = placed.map_from_robot;
      EXPECT_TRUE(std::isfinite(pose.x_m + pose.y_m + pose.theta_rad));
      EXPECT_EQ(placed.robot_from_sweep.size(), log.scans[placed.scan_index].sweeps.size());
    }
  }
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    EXPECT_EQ(result.scans[i].scan_index, i);
    ASSERT_EQ(component_of.count(i), 1U) << "all of these scans have shape";
    EXPECT_EQ(result.scans[i].component, component_of[i]);
  }
  EXPECT_EQ(component_of.size(), result.scans.size());
  for (const ClosedLoop& loop : result.loops) {
    EXPECT_LT(loop.a, loop.b);
    EXPECT_LT(loop.b, result.scans.size());
  }
}

void expect_same_bits(const MapResult& a, const MapResult& b) {
  ASSERT_EQ(sizes_of(a), sizes_of(b));
  for (std::size_t f = 0; f < a.components.size(); ++f) {
    for (std::size_t i = 0; i < a.components[f].scans.size(); ++i) {
      const PlacedScan& one = a.components[f].scans[i];
      const PlacedScan& other = b.components[f].scans[i];
      EXPECT_EQ(one.scan_index, other.scan_index);
      EXPECT_THAT(one.map_from_robot, HasSameBits(other.map_from_robot));
    }
  }
  ASSERT_EQ(a.loops.size(), b.loops.size());
  for (std::size_t k = 0; k < a.loops.size(); ++k) EXPECT_EQ(a.loops[k].strength, b.loops[k].strength);
}

/// A walk once round the ring and a few steps more.
struct Ring {
  Ring() { add_walk(log, test::ring_world(1), truth); }
  std::vector<Pose2> truth = test::ring_walk(test::kRingLap + 6, 2);
  Log log;
};

TEST(Mapper, ClosesTheLoopOfARing) {
  const Ring ring;
  const MapResult result = mapped(ring.log);
  expect_whole(result, ring.log);
  ASSERT_THAT(sizes_of(result), ElementsAre(ring.truth.size()));
  EXPECT_LT(test::worst_off_m(poses_of(result.components[0]), ring.truth), 0.15);
  const auto closes = [](const ClosedLoop& loop) { return loop.a < 10 && loop.b > test::kRingLap - 5; };
  EXPECT_TRUE(std::any_of(result.loops.begin(), result.loops.end(), closes));
  for (const ClosedLoop& loop : result.loops) {
    const Pose2 a_from_b = inverse(ring.truth[loop.a]) * ring.truth[loop.b];
    EXPECT_THAT(loop.a_from_b, test::IsNearPose(a_from_b, 0.20, 3 * kDegree)) << loop.a << " " << loop.b;
  }
  EXPECT_TRUE(result.scans[25].loop_constrained);
  EXPECT_GT(result.times.loops_s, 0.0);
}

TEST(Mapper, WithoutLoopsComposesTheEdges) {
  const Ring ring;
  MappingOptions options = quick();
  options.robust.loops.close_loops = false;
  const MapResult result = mapped(ring.log, options);
  expect_whole(result, ring.log);
  EXPECT_TRUE(result.loops.empty());
  const std::vector<Pose2> poses = poses_of(result.components.at(0));
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Pose2 composed = poses[i - 1] * result.scans[i].match.ref_from_query;
    EXPECT_THAT(poses[i], test::IsNearPose(composed, 1e-9, 1e-9));
    EXPECT_FALSE(result.scans[i].loop_constrained);
  }
}

struct TwoLogs {
  explicit TwoLogs(const test::World& other_world) {
    add_walk(log, test::ring_world(1), first);
    add_walk(log, other_world, second, 9);
  }
  std::vector<Pose2> first = test::ring_walk(14, 5);
  std::vector<Pose2> second = test::ring_walk(11, 6, 2.0);
  Log log;
};

TEST(Mapper, OfTwoLogsOfOnePlaceIsOneMap) {
  const TwoLogs two(test::ring_world(1));
  const MapResult result = mapped(two.log);
  expect_whole(result, two.log);
  ASSERT_THAT(sizes_of(result), ElementsAre(two.first.size() + two.second.size()));
  std::vector<Pose2> truth = two.first;
  truth.insert(truth.end(), two.second.begin(), two.second.end());
  EXPECT_LT(test::worst_off_m(poses_of(result.components[0]), truth), 0.15);
  EXPECT_FALSE(result.loops.empty());
  EXPECT_FALSE(result.scans[two.first.size()].starts_component);
}

TEST(Mapper, OfTwoLogsOfDifferentPlacesIsOneMapEach) {
  test::World other;  // is a hall with pillars
  test::add_box(other, {}, 9.0, 7.0);
  for (int k = 0; k < 9; ++k) test::add_box(other, {-6.0 + 1.4 * k, k % 3 - 1.0, 0.3 * k}, 0.2, 0.1 + 0.05 * k);
  const TwoLogs two(other);
  const MapResult result = mapped(two.log);
  expect_whole(result, two.log);
  EXPECT_THAT(sizes_of(result), ElementsAre(two.first.size(), two.second.size()));
  const ScanResult& start = result.scans[two.first.size()];
  EXPECT_TRUE(start.starts_component);
  EXPECT_FALSE(result.why_not_in_map(start).empty());
  for (const ClosedLoop& loop : result.loops) EXPECT_EQ(loop.a < two.first.size(), loop.b < two.first.size());
}

/// Scans of another session are no references, even if they are the same.
TEST(Mapper, MatchesNothingAcrossSessions) {
  Log log;
  const std::vector<Pose2> walk = test::ring_walk(5, 5);
  add_walk(log, test::ring_world(1), walk);
  MappingOptions options = quick();
  options.robust.loops.close_loops = false;
  ASSERT_EQ(mapped(log, options).components.size(), 1U);
  log.starts = {2, 4};
  EXPECT_THAT(sizes_of(mapped(log, options)), ElementsAre(2, 2, 1));
  log.scans.insert(log.scans.begin() + 4, test::blind_scan());  // the session starts blind
  EXPECT_THAT(sizes_of(mapped(log, options)), ElementsAre(2, 2, 1));
}

TEST(Mapper, IsTheSameToTheBitForAnyNumberOfThreads) {
  const TwoLogs two(test::ring_world(1));
  MappingOptions options = quick();
  const MapResult one = mapped(two.log, options);
  options.run.threads = 3;
  expect_same_bits(mapped(two.log, options), one);
}

TEST(Mapper, StoppedAtAnyTimeIsWhole) {
  const TwoLogs two(test::ring_world(1));
  MappingOptions options = quick();
  options.robust.loop_detection.likely_places = 2;
  test::Patience patient(100000);
  const MapResult whole = map_log(two.log, options, patient);
  EXPECT_FALSE(whole.interrupted);
  const std::size_t all = patient.asked;
  std::set<std::size_t> times{0, 1, 2, 3, 4, 5, all / 2, all - 1, all};
  for (const std::size_t n : times) {
    SCOPED_TRACE("of " + std::to_string(all) + " questions: " + std::to_string(n));
    test::Patience observer(n);
    const MapResult result = map_log(two.log, options, observer);
    EXPECT_TRUE(result.interrupted);
    expect_whole(result, two.log);
  }
  test::Patience just_enough(all + 1);
  const MapResult result = map_log(two.log, options, just_enough);
  EXPECT_FALSE(result.interrupted);
  expect_same_bits(result, whole);
}

}  // namespace
}  // namespace shapemap
