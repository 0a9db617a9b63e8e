// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "shapemap/mapper/map_log.hpp"
#include "support/matchers.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::IsNearPose;
using ::testing::Each;

constexpr std::size_t kBlock = 32;  // number of scans that are worked on together; it must not change a result

/// Returns the poses of a walk round the middle of the room, with any headings.
std::vector<Pose2> walk(std::size_t count) {
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<double>(i);
    poses.push_back({0.9 * std::cos(0.4 * k), 0.7 * std::sin(0.4 * k), wrap_angle(1.1 * k)});
  }
  return poses;
}

Log log_of(const std::vector<Pose2>& poses, const test::Scanner& scanner = test::full_circle()) {
  static const test::World world = test::cluttered_room(2);
  std::mt19937 rng(7);
  Log log;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    log.scans.push_back(test::scan_of(world, poses[i], scanner, rng));
    log.scans.back().timestamp_s = 100.0 + static_cast<double>(i);
  }
  return log;
}

MapResult mapped(const Log& log, const MappingOptions& options = {}) {
  MappingEvents nobody;
  return map_log(log, options, nobody);
}

/// Without loops, poses are the composed edges, whose errors add up.
MappingOptions without_loops(MappingOptions options = {}) {
  options.robust.loops.close_loops = false;
  return options;
}

/// Returns a coarser search, for tests that do not need the right pose.
MappingOptions quick() {
  MappingOptions options;
  options.robust.matcher.search.candidates.rotation_peaks = 3;
  options.robust.matcher.search.candidates.refined = 4;
  options.robust.matcher.search.candidates.kept = 3;
  options.robust.matcher.search.candidates.all_rotations_below = -100.0;
  options.robust.matcher.search.voting.peaks = 6;
  options.robust.loop_detection.likely_places = 3;
  options.robust.refinement.rounds = 1;
  return options;
}

/// All edges are in doubt, so that multi-reference candidates are searched.
MappingOptions in_doubt() {
  MappingOptions options = quick();
  options.robust.front_end.doubt_below = 1.0;
  return options;
}

void expect_same_bits(const ScanResult& a, const ScanResult& b) {
  EXPECT_EQ(a.component, b.component);
  EXPECT_EQ(a.starts_component, b.starts_component);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.match.status, b.match.status);
  EXPECT_THAT(a.match.ref_from_query, HasSameBits(b.match.ref_from_query));
  ASSERT_EQ(a.match.ranked.size(), b.match.ranked.size());
  for (std::size_t k = 0; k < a.match.ranked.size(); ++k) {
    EXPECT_THAT(a.match.ranked[k].ref_from_query, HasSameBits(b.match.ranked[k].ref_from_query));
    EXPECT_EQ(a.match.ranked[k].score, b.match.ranked[k].score);
  }
  if (!std::isnan(b.match.probability)) {
    EXPECT_EQ(a.match.probability, b.match.probability);
  }
}

void expect_same_bits(const MapResult& a, const MapResult& b) {
  ASSERT_EQ(a.scans.size(), b.scans.size());
  for (std::size_t i = 0; i < a.scans.size(); ++i) expect_same_bits(a.scans[i], b.scans[i]);
  ASSERT_EQ(a.placed().size(), b.placed().size());
  for (std::size_t i = 0; i < a.placed().size(); ++i) {
    EXPECT_THAT(a.placed()[i].map_from_robot, HasSameBits(b.placed()[i].map_from_robot)) << i;
  }
}

TEST(FrontEnd, FollowsAKnownWalkWithAnyHeading) {
  for (const std::size_t count : {kBlock - 1, kBlock, kBlock + 1, 2 * kBlock + 1}) {
    const std::vector<Pose2> truth = walk(count);
    const MapResult result = mapped(log_of(truth), without_loops());
    ASSERT_EQ(result.placed().size(), count);
    EXPECT_EQ(result.components.size(), 1U);
    for (std::size_t i = 1; i < count; ++i) {
      EXPECT_EQ(result.placed()[i].scan_index, i);
      const Pose2 step = inverse(truth[i - 1]) * truth[i];
      EXPECT_THAT(result.scans[i].match.ref_from_query, IsNearPose(step, 0.10, 2 * kDegree)) << i;
      const Pose2 map_from_robot = result.placed()[i - 1].map_from_robot * result.scans[i].match.ref_from_query;
      EXPECT_THAT(result.placed()[i].map_from_robot, HasSameBits(map_from_robot)) << "the alignments in a row";
    }
  }
}

TEST(FrontEnd, OfNothingAndOfBlindScansIsNoMap) {
  EXPECT_TRUE(mapped({}).scans.empty());
  Log log;
  log.scans.assign(kBlock + 2, test::blind_scan());
  const MapResult result = mapped(log);
  EXPECT_TRUE(result.components.empty());
  EXPECT_EQ(result.largest_component, -1);
  ASSERT_EQ(result.scans.size(), kBlock + 2);
  for (const ScanResult& scan : result.scans) EXPECT_FALSE(scan.reason.empty());
}

TEST(FrontEnd, OfOneScanIsOneComponentOfOneAtTheOrigin) {
  const MapResult result = mapped(log_of({{0.3, 0.2, 0.5}}));
  ASSERT_EQ(result.placed().size(), 1U);
  EXPECT_THAT(result.placed()[0].map_from_robot, HasSameBits(Pose2{}));
  EXPECT_TRUE(result.scans[0].starts_component);
  EXPECT_TRUE(result.scans[0].reason.empty());
}

TEST(FrontEnd, ABlindScanIsReportedAndSplitsNothing) {
  const std::vector<Pose2> truth = walk(6);
  const MapResult whole = mapped(log_of(truth));
  Log log = log_of(truth);
  log.scans.insert(log.scans.begin() + 3, test::blind_scan());
  const MapResult result = mapped(log);
  EXPECT_EQ(result.components.size(), 1U);
  ASSERT_EQ(result.placed().size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(result.placed()[i].scan_index, i < 3 ? i : i + 1);
    EXPECT_THAT(result.placed()[i].map_from_robot, HasSameBits(whole.placed()[i].map_from_robot));
  }
  const ScanResult& blind = result.scans[3];
  EXPECT_EQ(blind.match.status, MatchStatus::kNoShape);
  EXPECT_EQ(blind.component, -1);
  EXPECT_FALSE(blind.starts_component);
  EXPECT_EQ(blind.reason, "only 0 shape points, 10 are needed");
  EXPECT_EQ(result.why_not_in_map(blind), blind.reason);
  EXPECT_EQ(result.why_not_in_map(result.scans[4]), "");
}

TEST(FrontEnd, IsTheSameToTheBitForAnyNumberOfThreads) {
  const Log log = log_of(walk(kBlock + 8));
  for (MappingOptions options : {quick(), in_doubt()}) {
    const MapResult one = mapped(log, options);
    for (const int threads : {2, 4}) {
      options.run.threads = threads;
      expect_same_bits(mapped(log, options), one);
    }
  }
}

/// Blind scans at the start shift the borders of the blocks.
TEST(FrontEnd, BordersOfBlocksChangeNothing) {
  const Log log = log_of(walk(kBlock + 8));
  for (const MappingOptions& options : {quick(), in_doubt()}) {
    const MapResult result = mapped(log, options);
    for (const std::size_t shift : {std::size_t{1}, kBlock / 2, kBlock - 1}) {
      Log shifted = log;
      shifted.scans.insert(shifted.scans.begin(), shift, test::blind_scan());
      MapResult later = mapped(shifted, options);
      later.scans.erase(later.scans.begin(), later.scans.begin() + static_cast<std::ptrdiff_t>(shift));
      expect_same_bits(later, result);
    }
  }
}

TEST(FrontEnd, PosesThatAScanMayHaveAreApart) {
  for (const ScanResult& scan : mapped(log_of(walk(12)), in_doubt()).scans) {
    const std::vector<RankedPose>& ranked = scan.match.ranked;
    for (std::size_t i = 0; i < ranked.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const Pose2 a = ranked[i].ref_from_query;
        const Pose2 b = ranked[k].ref_from_query;
        EXPECT_TRUE((a.translation() - b.translation()).norm() > 0.05 ||
                    angle_between(a.theta_rad, b.theta_rad) > kDegree)
            << scan.scan_index;
      }
    }
  }
}

struct Stopper : MappingEvents {
  explicit Stopper(std::size_t times) : stop_at(times) {}
  bool keep_going() override { return ++asked < stop_at; }
  void on_stage(std::string_view stage) override { is_tracking = stage == "chain"; }
  void on_progress(std::size_t now_done, std::size_t of) override {
    if (!is_tracking) return;
    EXPECT_GT(now_done, done);
    EXPECT_LE(now_done, of);
    done = now_done;
  }
  std::size_t stop_at;
  std::size_t asked = 0;
  std::size_t done = 0;  ///< number of scans
  bool is_tracking = false;
};

TEST(FrontEnd, TellsTheObserverUntilAllIsDone) {
  Stopper watcher(1000);
  const MapResult result = map_log(log_of(walk(kBlock + 3)), without_loops(), watcher);
  EXPECT_EQ(watcher.done, kBlock + 3);
  EXPECT_GE(watcher.asked, 2U);
  EXPECT_FALSE(result.interrupted);
}

TEST(FrontEnd, StoppedItIsTheMapOfWhatItHasSeen) {
  const Log log = log_of(walk(2 * kBlock + 5));
  for (const std::size_t stop_at : {1U, 2U, 3U}) {
    Stopper watcher(stop_at);
    const MapResult result = map_log(log, quick(), watcher);
    EXPECT_TRUE(result.interrupted);
    ASSERT_LT(result.scans.size(), log.scans.size());
    ASSERT_EQ(result.scans.size(), watcher.done);
    Log seen = log;
    seen.scans.resize(watcher.done);
    expect_same_bits(result, mapped(seen, quick()));
  }
}

TEST(FrontEnd, SplitsWhereItIsToldToAndSaysWhy) {
  const Log log = log_of(walk(5));
  MappingOptions options;
  options.robust.front_end.split_below = 1.0;
  const MapResult result = mapped(log, options);
  EXPECT_EQ(result.components.size(), 5U);
  EXPECT_EQ(result.placed().size(), 1U);
  for (std::size_t i = 1; i < 5; ++i) {
    const ScanResult& scan = result.scans[i];
    EXPECT_EQ(scan.component, static_cast<int>(i));
    EXPECT_TRUE(scan.starts_component);
    EXPECT_TRUE(scan.match.has_pose()) << "what was found is told all the same";
    EXPECT_FALSE(scan.reason.empty()) << "a split has a reason";
    EXPECT_THAT(result.components[i].scans[0].map_from_robot, HasSameBits(Pose2{}));
  }
  options.robust.front_end.split_below = 0.0;
  EXPECT_EQ(mapped(log, options).components.size(), 1U);
}

TEST(FrontEnd, RefusedMatchesKeepTheMapInOnePieceAndAreReported) {
  MappingOptions options;
  options.robust.matcher.confidence.min_agree = 1.0;
  const MapResult result = mapped(log_of(walk(4)), options);
  EXPECT_EQ(result.components.size(), 1U);
  EXPECT_EQ(result.placed().size(), 4U);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(result.scans[i].match.status, MatchStatus::kTooLittleOverlap);
    EXPECT_EQ(result.scans[i].reason, result.scans[i].match.reason);
    EXPECT_FALSE(result.scans[i].reason.empty());
  }
}

TEST(FrontEnd, ExtremeOptionsStillMakeAMap) {
  const Log log = log_of(walk(kBlock + 2));
  for (const int more_references : {0, 1, 10}) {
    for (const double three_scan_weight : {0.0, 10.0}) {
      MappingOptions options = in_doubt();
      options.robust.front_end.more_references = more_references;
      options.robust.front_end.three_scan_weight = three_scan_weight;
      options.robust.matcher.search.candidates.kept = 2;
      const MapResult result = mapped(log, options);
      EXPECT_EQ(result.scans.size(), log.scans.size());
      EXPECT_EQ(result.placed().size(), log.scans.size());
    }
  }
}

TEST(FrontEnd, NeverLooksAtTheReferencePosesAndHasNoCorrections) {
  Log log = log_of(walk(4));
  const MapResult without = mapped(log);
  for (Scan& scan : log.scans) scan.reference_pose = Pose2{99.0, -99.0, 1.0};
  const MapResult with = mapped(log);
  expect_same_bits(with, without);
  for (const PlacedScan& placed : with.placed()) {
    EXPECT_THAT(placed.robot_from_sweep, Each(Pose2{}));
    EXPECT_EQ(placed.robot_from_sweep.size(), 1U);
  }
}

TEST(FrontEnd, CountsTheSecondsOfItsStages) {
  const MapResult result = mapped(log_of(walk(3)));
  EXPECT_GT(result.times.shape_s, 0.0);
  EXPECT_GT(result.times.align_s, 0.0);
  EXPECT_EQ(result.times.icp_s, 0.0);
}

/// In a room with a bare corridor, the motion prior that was learned in the room decides about the corridor.
TEST(FrontEnd, GoesAlongABareCorridorAsFarAsItUsuallyDoes) {
  test::World world = test::bare_corridor();
  for (int k = 0; k < 14; ++k) test::add_box(world, {0.9 * k, k % 2 == 0 ? 0.9 : -0.9, 0.3 * k}, 0.2, 0.15);
  Log log;
  std::mt19937 rng(5);
  std::vector<Pose2> truth;
  for (int k = 0; k < 40; ++k) truth.push_back({0.7 * k, 0.1 * std::sin(1.3 * k), 0.1 * std::sin(2.1 * k)});
  for (const Pose2& pose : truth) log.scans.push_back(test::scan_of(world, pose, test::half_circle(), rng));
  const MapResult result = mapped(log, without_loops());
  ASSERT_EQ(result.components.size(), 1U);
  const std::vector<PlacedScan>& placed = result.components[0].scans;
  ASSERT_EQ(placed.size(), truth.size());
  for (std::size_t k = 1; k < placed.size(); ++k) {
    const Pose2 step = inverse(placed[k - 1].map_from_robot) * placed[k].map_from_robot;
    EXPECT_THAT(step, IsNearPose(inverse(truth[k - 1]) * truth[k], 0.35, 5 * kDegree)) << k;
  }
}

/// The views that are released meanwhile must not change the result.
TEST(FrontEnd, OfMoreKeyframesThanAreKeptWithoutLoopsIsOne) {
  MappingOptions options = without_loops(quick());
  options.robust.keyframes.step_m = 0.0;
  options.robust.keyframes.settle_at = 70;
  const Log log = log_of(walk(200));
  const MapResult result = mapped(log, options);
  ASSERT_EQ(result.components.size(), 1U);
  EXPECT_EQ(result.components[0].scans.size(), 200U);
}

}  // namespace
}  // namespace shapemap
