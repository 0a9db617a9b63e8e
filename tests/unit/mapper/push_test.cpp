// SPDX-License-Identifier: GPL-3.0-or-later
// Scans are pushed into a mapper, one by one or several at a time.
#include <gmock/gmock.h>

#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "shapemap/core/errors.hpp"
#include "shapemap/mapper/map_log.hpp"
#include "shapemap/mapper/mapper.hpp"
#include "support/map_results.hpp"
#include "support/ring_laps.hpp"
#include "support/sweeps_at_stops.hpp"

namespace shapemap {
namespace {

/// Three laps round a ring, so that keyframes are culled, and the robot is localized.
const test::Laps& laps() {
  static const test::Laps three_laps(3 * test::kRingLap);
  return three_laps;
}

/// One lap and the start of the next.
const test::Laps& one_lap() {
  static const test::Laps lap(test::kRingLap + 10);
  return lap;
}

MappingOptions culling() {
  MappingOptions options = test::quick_mapping();
  options.robust.keyframes.settle_at = 64;
  return options;
}

struct Pushed {
  MapResult result;
  std::vector<ScanUpdate> updates;
  std::vector<std::shared_ptr<const Map>> maps;
};

/// Pushes `group` scans at a time; 0: all at once.
Pushed pushed(const Log& log, const MappingOptions& options, const LiveOptions& live, std::size_t group) {
  Pushed all;
  Mapper mapper(options, live);
  const auto look = [&] {
    const std::shared_ptr<const Map> map = mapper.map();
    if (map && (all.maps.empty() || all.maps.back() != map)) all.maps.push_back(map);
  };
  const std::size_t step = group == 0 ? log.scans.size() : group;
  for (std::size_t first = 0; first < log.scans.size(); first += step) {
    const std::size_t count = std::min(step, log.scans.size() - first);
    for (ScanUpdate& update : mapper.add_scans(&log.scans[first], count)) all.updates.push_back(std::move(update));
    look();
  }
  all.result = mapper.finish();
  look();
  return all;
}

MapResult mapped(const Log& log, const MappingOptions& options) {
  MappingEvents nobody;
  return map_log(log, options, nobody);
}

TEST(Push, GivesTheMapOfTheLogHoweverScansAreGrouped) {
  const MapResult expected = mapped(laps().log, culling());
  const auto attached = std::count_if(expected.scans.begin(), expected.scans.end(),
                                      [](const ScanResult& scan) { return !scan.is_keyframe; });
  ASSERT_GT(attached, 20) << "nothing was culled: this tests little";
  MappingOptions two_threads = culling();
  two_threads.run.threads = 2;
  test::expect_same_bits(pushed(laps().log, culling(), {true, false}, 1).result, expected);
  test::expect_same_bits(pushed(laps().log, two_threads, {true, true}, 7).result, expected);
}

TEST(Push, TakesScansOfSeveralSweeps) {
  const test::Stops stops = test::stops_on_ring(12, 1.2, 3, 0.02, 2 * kDegree);
  const MapResult expected = mapped(stops.log, {});
  ASSERT_EQ(expected.placed().front().robot_from_sweep.size(), static_cast<std::size_t>(test::kTurns));
  for (const bool background : {false, true}) {
    test::expect_same_bits(pushed(stops.log, {}, {true, background}, 1).result, expected);
  }
}

TEST(Push, HasAPoseForEachScanAtOnce) {
  const Pushed all = pushed(one_lap().log, culling(), {}, 1);
  ASSERT_EQ(all.updates.size(), one_lap().truth.size());
  for (std::size_t i = 0; i < all.updates.size(); ++i) {
    SCOPED_TRACE(i);
    const ScanUpdate& update = all.updates[i];
    EXPECT_EQ(update.scan, i);
    EXPECT_NE(update.role, ScanRole::kNoShape);
    ASSERT_EQ(update.pose.component, 0);
    const Pose2 first_from_robot = inverse(one_lap().truth.front()) * one_lap().truth[i];
    EXPECT_THAT(update.pose.map_from_robot, test::IsNearPose(first_from_robot, 0.4, 6 * kDegree));
    if (i == 0) {
      EXPECT_EQ(update.reference, kNoReference);
      continue;
    }
    ASSERT_LT(update.reference, i);
    const Pose2 step = inverse(one_lap().truth[update.reference]) * one_lap().truth[i];
    EXPECT_THAT(update.reference_from_robot, test::IsNearPose(step, 0.1, 2 * kDegree));
    EXPECT_GT(update.probability, 0.5);
    EXPECT_GT(update.covariance.determinant(), 0.0);
  }
}

TEST(Push, HasMapsFromEarlyOnThatNeverChange) {
  const Pushed all = pushed(one_lap().log, culling(), {}, 1);
  ASSERT_GT(all.maps.size(), 5U);
  EXPECT_LE(all.maps.front()->scans.size(), 12U) << "the first map comes late";
  std::size_t largest_gap = 0;
  for (std::size_t k = 0; k < all.maps.size(); ++k) {
    const Map& map = *all.maps[k];
    EXPECT_EQ(map.version, k + 1) << "of the maps that were made one was not seen, or changed";
    EXPECT_EQ(map.is_final, k + 1 == all.maps.size());
    if (k > 0) largest_gap = std::max(largest_gap, map.scans.size() - all.maps[k - 1]->scans.size());
    for (std::size_t i = 0; i < map.scans.size(); ++i) {
      if (map.scans[i].component != 0) continue;
      const Pose2 first_from_robot = inverse(one_lap().truth.front()) * one_lap().truth[i];
      EXPECT_THAT(map.scans[i].map_from_robot, test::IsNearPose(first_from_robot, 0.4, 6 * kDegree)) << k << " " << i;
    }
  }
  EXPECT_LT(largest_gap, one_lap().truth.size() / 2);
}

TEST(Push, SaysWhatHasMovedSince) {
  Mapper mapper(culling());
  std::vector<ScanPose> known;
  MapVersion version = 0;
  const auto catch_up = [&] {
    const Corrections since = mapper.corrections_since(version);
    for (const Correction& correction : since.corrections) {
      if (correction.scan >= known.size()) known.resize(correction.scan + 1);
      known[correction.scan] = correction.pose;
    }
    version = since.version;
  };
  for (std::size_t i = 0; i < one_lap().log.scans.size(); ++i) {
    mapper.add_scan(one_lap().log.scans[i]);
    if (i % 30 == 29) catch_up();
  }
  const MapResult result = mapper.finish();
  EXPECT_FALSE(mapper.corrections_since(version).corrections.empty());
  catch_up();
  EXPECT_EQ(known, mapper.map()->scans);
  EXPECT_TRUE(mapper.corrections_since(version).corrections.empty());
  for (const PlacedScan& placed : result.placed()) {
    EXPECT_THAT(known[placed.scan_index].map_from_robot, test::HasSameBits(placed.map_from_robot));
  }
}

TEST(Push, KnowsNothingOfTheMotionBetweenSessions) {
  const std::size_t count = 12;
  Log two;
  two.scans.assign(one_lap().log.scans.begin(), one_lap().log.scans.begin() + count);
  two.scans.insert(two.scans.end(), one_lap().log.scans.begin(), one_lap().log.scans.begin() + count);
  two.starts = {count};
  const MapResult expected = mapped(two, culling());
  Mapper mapper(culling());
  for (std::size_t i = 0; i < two.scans.size(); ++i) {
    const ScanUpdate update = mapper.add_scan(two.scans[i], i < count ? 0 : 1);
    if (i == count) {
      EXPECT_EQ(update.reference, kNoReference);
      EXPECT_EQ(update.pose.component, -1);
    }
  }
  test::expect_same_bits(mapper.finish(), expected);
}

TEST(Push, ReportsAScanWithoutShape) {
  Mapper mapper(culling());
  mapper.add_scan(one_lap().log.scans[0]);
  const ScanUpdate blind = mapper.add_scan(test::blind_scan());
  EXPECT_EQ(blind.role, ScanRole::kNoShape);
  EXPECT_EQ(blind.pose.component, -1);
  EXPECT_EQ(mapper.add_scan(one_lap().log.scans[1]).pose.component, 0);
  const MapResult result = mapper.finish();
  EXPECT_EQ(result.scans[1].component, -1);
  EXPECT_THAT(result.scans[1].reason, testing::HasSubstr("shape points"));
  EXPECT_EQ(mapper.map()->scans[1].component, -1);
}

TEST(Push, RefusesWhatNoSensorRecordsAndGoesOn) {
  for (const bool background : {false, true}) {
    Mapper mapper(culling(), {true, background});
    mapper.add_scan(one_lap().log.scans[0]);
    Scan damaged = one_lap().log.scans[1];
    damaged.sweeps.front().angle_step_rad = 1e12;
    EXPECT_THROW(mapper.add_scan(damaged), InputError);
    mapper.add_scan(one_lap().log.scans[1]);
    EXPECT_EQ(mapper.finish().placed().size(), 2U);
    EXPECT_THROW(mapper.add_scan(one_lap().log.scans[2]), std::logic_error);
    EXPECT_THROW(mapper.finish(), std::logic_error);
  }
  MappingOptions wrong;
  wrong.robust.front_end.split_below = 2.0;
  EXPECT_THROW(Mapper{wrong}, ConfigError);
}

TEST(Push, AListenerThatThrowsEndsTheMapper) {
  struct Full : MappingEvents {
    void on_scan(const ScanUpdate& scan) override {
      if (scan.scan == 2) throw std::runtime_error("full");
    }
  };
  for (const bool background : {false, true}) {
    Full full;
    Mapper mapper(culling(), {true, background}, &full);
    const std::vector<Scan>& scans = one_lap().log.scans;
    mapper.add_scans(scans.data(), 2);
    EXPECT_THROW(mapper.add_scans(&scans[2], 3), std::runtime_error);
    EXPECT_THROW(mapper.add_scan(scans[5]), std::logic_error);
    EXPECT_THROW(mapper.finish(), std::logic_error);
  }
}

TEST(Push, OfNothingIsNoMap) {
  for (const bool background : {false, true}) {
    Mapper mapper(culling(), {true, background});
    EXPECT_EQ(mapper.map(), nullptr);
    EXPECT_TRUE(mapper.corrections_since(0).corrections.empty());
    EXPECT_TRUE(mapper.finish().components.empty());
    EXPECT_TRUE(mapper.map()->is_final);
  }
}

/// The destructor of a mapper does not wait for a map that nobody will see.
TEST(Push, MayBeLeftUnfinished) {
  for (const bool background : {false, true}) {
    Mapper mapper(culling(), {true, background});
    mapper.add_scans(one_lap().log.scans.data(), one_lap().log.scans.size());
  }
}

/// Two other threads only ever see whole maps.
TEST(Push, LetsOthersLookOn) {
  Mapper mapper(culling(), {true, true});
  std::atomic<bool> is_done{false};
  const auto watch = [&] {
    MapVersion version = 0;
    while (!is_done) {
      const std::shared_ptr<const Map> map = mapper.map();
      const Corrections since = mapper.corrections_since(version);
      EXPECT_GE(since.version, version);
      EXPECT_GE(since.version, map ? map->version : 0);
      version = since.version;
    }
  };
  std::thread one(watch);
  std::thread other(watch);
  for (const Scan& scan : one_lap().log.scans) mapper.add_scan(scan);
  mapper.finish();
  is_done = true;
  one.join();
  other.join();
}

}  // namespace
}  // namespace shapemap
