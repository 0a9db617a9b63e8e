// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/map_log.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "shapemap/core/errors.hpp"
#include "shapemap/paper/paper_align.hpp"
#include "support/matchers.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::IsNearPose;
using ::testing::ElementsAre;

/// Returns the poses of a slow walk through the middle of the room.
std::vector<Pose2> walk(std::size_t count) {
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<double>(i);
    poses.push_back({-0.4 + 0.15 * k, 0.1 * std::sin(k), 1.2 * kDegree * std::cos(2 * k)});
  }
  return poses;
}

Log log_of(const test::World& world, const std::vector<Pose2>& poses, const test::Scanner& scanner = {}) {
  std::mt19937 rng(7);
  Log log;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    log.scans.push_back(test::scan_of(world, poses[i], scanner, rng));
    log.scans.back().timestamp_s = 100.0 + static_cast<double>(i);
  }
  return log;
}

Scan blind() {
  Scan scan = test::scan_of(test::uneven_room(), {});
  for (float& range_m : scan.sweeps[0].ranges_m) range_m = std::nanf("");
  return scan;
}

test::Scanner four_sweeps() {
  test::Scanner scanner;
  scanner.num_sweeps = 4;
  scanner.num_beams = 200;
  scanner.view_rad = 100 * kDegree;
  return scanner;
}

MapResult mapped(const Log& log, const MappingOptions& options = test::paper_options()) {
  MappingEvents nobody;
  return map_log(log, options, nobody);
}

std::vector<int> components_of(const MapResult& result) {
  std::vector<int> components;
  for (const ScanResult& scan : result.scans) components.push_back(scan.component);
  return components;
}

TEST(MapLog, OfNoScansIsNoMap) {
  const MapResult result = mapped({});
  EXPECT_TRUE(result.components.empty());
  EXPECT_TRUE(result.scans.empty());
  EXPECT_EQ(result.largest_component, -1);
  EXPECT_TRUE(result.placed().empty());
  EXPECT_FALSE(result.interrupted);
}

TEST(MapLog, OfOneScanIsOneComponentOfOneAtTheOrigin) {
  const MapResult result = mapped(log_of(test::uneven_room(), {{0.3, 0.2, 0.5}}));
  ASSERT_EQ(result.components.size(), 1U);
  EXPECT_EQ(result.largest_component, 0);
  ASSERT_EQ(result.placed().size(), 1U);
  EXPECT_THAT(result.placed()[0].map_from_robot, HasSameBits(Pose2{}));
  EXPECT_EQ(result.placed()[0].timestamp_s, 100.0);
  ASSERT_EQ(result.scans.size(), 1U);
  EXPECT_TRUE(result.scans[0].starts_component);
}

TEST(MapLog, IdenticalScansAreAllAtTheOrigin) {
  const MapResult result = mapped(log_of(test::cluttered_room(1), std::vector<Pose2>(5)));
  ASSERT_EQ(result.placed().size(), 5U);
  for (const PlacedScan& placed : result.placed()) {
    EXPECT_THAT(placed.map_from_robot, IsNearPose(Pose2{}, 1e-5, 1e-5));
  }
}

TEST(MapLog, FollowsAKnownWalk) {
  const std::vector<Pose2> truth = walk(6);
  test::Scanner scanner;
  scanner.noise_m = 0.005;
  const MapResult result = mapped(log_of(test::cluttered_room(2), truth, scanner));
  ASSERT_EQ(result.placed().size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(result.placed()[i].scan_index, i);
    EXPECT_THAT(result.placed()[i].map_from_robot, IsNearPose(inverse(truth[0]) * truth[i], 0.08, 1.5 * kDegree)) << i;
  }
}

TEST(MapLog, LooksBackNoFartherThanTheTargetScans) {
  const Log log = log_of(test::cluttered_room(3), walk(4));
  MappingOptions options = test::paper_options();
  options.paper.target.target_scans = 1;
  const MapResult result = mapped(log, options);
  ASSERT_EQ(result.placed().size(), 4U);
  for (std::size_t i = 1; i < 4; ++i) {
    const PaperAlignment pair =
        paper_align(test::shape_of(log.scans[i - 1], options), test::shape_of(log.scans[i], options), options.paper);
    EXPECT_THAT(result.scans[i].paper->ref_from_query, IsNearPose(pair.ref_from_query, 1e-9, 1e-9)) << i;
    EXPECT_EQ(result.scans[i].paper->overlap, pair.overlap) << i;
  }
}

TEST(MapLog, PosesAreTheAlignmentsInARow) {
  const MapResult result = mapped(log_of(test::cluttered_room(3), walk(6)));
  ASSERT_EQ(result.placed().size(), 6U);
  Pose2 map_from_robot;
  for (std::size_t i = 1; i < 6; ++i) {
    ASSERT_TRUE(result.scans[i].paper && result.scans[i].paper->ok());
    map_from_robot = map_from_robot * result.scans[i].paper->ref_from_query;
    EXPECT_THAT(result.placed()[i].map_from_robot, IsNearPose(map_from_robot, 1e-12, 1e-12)) << i;
  }
}

TEST(MapLog, AScanWithoutReturnsIsInNoComponentAndTheNextStartsOne) {
  Log log = log_of(test::cluttered_room(2), walk(4));
  log.scans.insert(log.scans.begin() + 2, blind());
  const MapResult result = mapped(log);
  EXPECT_THAT(components_of(result), ElementsAre(0, 0, -1, 1, 1));
  ASSERT_TRUE(result.scans[2].paper);
  EXPECT_EQ(result.scans[2].paper->status, PaperStatus::kNoShape);
  EXPECT_EQ(result.scans[2].reason, "only 0 shape points, 10 are needed");
  EXPECT_FALSE(result.scans[2].starts_component);
  EXPECT_TRUE(result.scans[3].starts_component);
  EXPECT_FALSE(result.scans[4].starts_component);
  EXPECT_THAT(result.components[1].scans[0].map_from_robot, HasSameBits(Pose2{}));
}

TEST(MapLog, OfBlindScansIsNoMapButAReportOfEach) {
  Log log;
  log.scans.assign(3, blind());
  const MapResult result = mapped(log);
  EXPECT_TRUE(result.components.empty());
  EXPECT_EQ(result.largest_component, -1);
  ASSERT_EQ(result.scans.size(), 3U);
  for (const ScanResult& scan : result.scans) EXPECT_FALSE(scan.reason.empty());
}

TEST(MapLog, AScanThatIsNotTrustedStartsAComponentAndSaysWhy) {
  MappingOptions options = test::paper_options();
  options.paper.trust.min_correspondences = 100000;
  const MapResult result = mapped(log_of(test::cluttered_room(2), walk(3)), options);
  EXPECT_THAT(components_of(result), ElementsAre(0, 1, 2));
  ASSERT_TRUE(result.scans[1].paper);
  EXPECT_EQ(result.scans[1].paper->status, PaperStatus::kTooFewCorrespondences);
  EXPECT_EQ(result.scans[1].reason, result.scans[1].paper->reason);
  EXPECT_FALSE(result.scans[1].reason.empty());
  EXPECT_TRUE(result.scans[0].reason.empty());
}

TEST(MapLog, TheLargestComponentMakesTheMap) {
  Log log = log_of(test::cluttered_room(2), walk(5));
  log.scans.insert(log.scans.begin() + 2, blind());
  const MapResult result = mapped(log);
  EXPECT_EQ(result.largest_component, 1);
  ASSERT_EQ(result.placed().size(), 3U);
  EXPECT_EQ(result.placed()[0].scan_index, 3U);
}

TEST(MapLog, OfEquallyLargeComponentsTheFirstMakesTheMap) {
  Log log = log_of(test::cluttered_room(2), walk(4));
  log.scans.insert(log.scans.begin() + 2, blind());
  EXPECT_EQ(mapped(log).largest_component, 0);
}

/// Records the progress, and asks to stop at the `stop_at`th question after `done` scans.
struct Watcher : MappingEvents {
  explicit Watcher(std::size_t stop, std::size_t done = 0) : stop_at(stop), stop_after(done) {}
  void on_progress(std::size_t done, std::size_t total) override { progress.emplace_back(done, total); }
  bool keep_going() override { return progress.size() < stop_after || ++asked < stop_at; }

  std::size_t stop_at;
  std::size_t stop_after;
  std::size_t asked = 0;
  std::vector<std::pair<std::size_t, std::size_t>> progress;
};

TEST(MapLog, TellsTheObserverOfEachScan) {
  Watcher watcher(100);
  const MapResult result = map_log(log_of(test::uneven_room(), walk(3)), test::paper_options(), watcher);
  using Step = std::pair<std::size_t, std::size_t>;
  EXPECT_THAT(watcher.progress, ElementsAre(Step(1, 3), Step(2, 3), Step(3, 3)));
  EXPECT_GT(watcher.asked, 3U) << "within alignments as well";
  EXPECT_FALSE(result.interrupted);
}

TEST(MapLog, StopsWhenTheObserverAsksAndKeepsWhatIsMapped) {
  const Log log = log_of(test::cluttered_room(2), walk(4));
  const MapResult whole = mapped(log);
  for (const int threads : {1, 4}) {
    for (const std::size_t stop_at : {1U, 2U, 4U, 7U}) {  // before the third scan, at a rotation, after the last
      if (threads > 1 && stop_at > 2) continue;  // the number of questions depends on how threads share the work
      Watcher watcher(stop_at, 2);
      MappingOptions options = test::paper_options();
      options.run.threads = threads;
      const MapResult result = map_log(log, options, watcher);
      EXPECT_TRUE(result.interrupted) << stop_at;
      EXPECT_EQ(result.scans.size(), 2U);
      ASSERT_EQ(result.placed().size(), 2U);
      EXPECT_THAT(result.placed()[1].map_from_robot, HasSameBits(whole.placed()[1].map_from_robot));
    }
  }
}

TEST(MapLog, StoppedAtOnceHasNothing) {
  Watcher watcher(1);
  const MapResult result = map_log(log_of(test::uneven_room(), walk(2)), test::paper_options(), watcher);
  EXPECT_TRUE(result.interrupted);
  EXPECT_TRUE(result.scans.empty());
  EXPECT_EQ(result.largest_component, -1);
}

TEST(MapLog, EveryScanHasACorrectionPerSweep) {
  const Log log = log_of(test::cluttered_room(2), walk(3), four_sweeps());
  for (const bool decoupled : {false, true}) {
    MappingOptions options = test::paper_options();
    options.paper.icp.decoupled = decoupled;
    const MapResult result = mapped(log, options);
    ASSERT_EQ(result.placed().size(), 3U);
    for (const PlacedScan& placed : result.placed()) ASSERT_EQ(placed.robot_from_sweep.size(), 4U);
    bool any_correction = false;
    for (const Pose2& correction : result.placed()[1].robot_from_sweep) {
      any_correction = any_correction || !(correction == Pose2{});
    }
    EXPECT_EQ(any_correction, decoupled);
  }
}

TEST(MapLog, IsTheSameToTheBitForAnyNumberOfThreads) {
  const Log log = log_of(test::cluttered_room(4), walk(4), four_sweeps());
  MappingOptions options = test::paper_options();
  options.paper.icp.decoupled = true;
  options.run.threads = 1;
  const MapResult one = mapped(log, options);
  options.run.threads = 4;
  const MapResult four = mapped(log, options);
  ASSERT_EQ(one.placed().size(), 4U);
  ASSERT_EQ(four.placed().size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_THAT(four.placed()[i].map_from_robot, HasSameBits(one.placed()[i].map_from_robot));
    for (std::size_t s = 0; s < 4; ++s) {
      EXPECT_THAT(four.placed()[i].robot_from_sweep[s], HasSameBits(one.placed()[i].robot_from_sweep[s]));
    }
  }
}

TEST(MapLog, NeverLooksAtTheReferencePoses) {
  Log log = log_of(test::cluttered_room(2), walk(3));
  const MapResult without = mapped(log);
  for (Scan& scan : log.scans) scan.reference_pose = Pose2{99.0, -99.0, 1.0};
  const MapResult with = mapped(log);
  ASSERT_EQ(with.placed().size(), without.placed().size());
  for (std::size_t i = 0; i < with.placed().size(); ++i) {
    EXPECT_THAT(with.placed()[i].map_from_robot, HasSameBits(without.placed()[i].map_from_robot));
  }
}

TEST(MapLog, BadOptionsAreRefusedBeforeAnythingIsDone) {
  MappingOptions options = test::paper_options();
  options.paper.target.target_scans = 0;
  Watcher watcher(100);
  EXPECT_THROW(map_log(log_of(test::uneven_room(), walk(1)), options, watcher), ConfigError);
  EXPECT_EQ(watcher.asked, 0U);
}

TEST(MapLog, CountsTheSecondsOfItsStages) {
  const MapResult result = mapped(log_of(test::cluttered_room(2), walk(3)));
  EXPECT_GT(result.times.shape_s, 0.0);
  EXPECT_GT(result.times.align_s, 0.0);
  EXPECT_GT(result.times.icp_s, 0.0);
}

}  // namespace
}  // namespace shapemap
