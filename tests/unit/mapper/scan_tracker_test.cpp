// SPDX-License-Identifier: GPL-3.0-or-later
#include "mapper/scan_tracker.hpp"

#include <gmock/gmock.h>

#include "shapemap/mapper/map_log.hpp"
#include "support/matchers.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

using test::IsNearPose;

std::shared_ptr<const ScanView> view_at(const Pose2& pose, unsigned seed = 1) {
  return std::make_shared<ScanView>(test::view_from(test::ring_world(1), pose, test::full_circle(), seed));
}

Pose2 ahead(double along_m) { return test::on_ring(3.0 + along_m); }

TEST(ScanTracker, AttachesScansThatFollowCloselyAtTheRightPlace) {
  const MappingOptions options;
  ScanTracker tracker(options.robust);
  tracker.start(view_at(ahead(0.0)));
  for (unsigned k = 1; k <= 8; ++k) {
    const Pose2 pose = ahead(0.05 * k) * Pose2{0.0, 0.0, 1.5 * kDegree * k};
    const auto found = tracker.follow(*view_at(pose, k));
    ASSERT_TRUE(found) << k;
    EXPECT_THAT(found->ref_from_query, IsNearPose(inverse(ahead(0.0)) * pose, 0.04, 1 * kDegree)) << k;
  }
}

TEST(ScanTracker, ADistanceOrATurnTooFarMakesAKeyframe) {
  MappingOptions options;
  for (const bool turning : {false, true}) {
    ScanTracker tracker(options.robust);
    tracker.start(view_at(ahead(0.0)));
    unsigned k = 1;
    for (bool attached = true; attached && k < 40; ++k) {
      const Pose2 step = turning ? Pose2{0.0, 0.0, 4 * kDegree * k} : Pose2{0.08 * k, 0.0, 0.0};
      attached = tracker.follow(*view_at(ahead(0.0) * step, k)).has_value();
    }
    const unsigned expected = turning ? 5 : 6;  // limits of 0.50 m and 20 degrees
    EXPECT_NEAR(static_cast<double>(k - 1), expected + 0.5, 1.0) << turning;
  }
}

TEST(ScanTracker, AJumpMakesAKeyframe) {
  const MappingOptions options;
  ScanTracker tracker(options.robust);
  for (const Pose2& jumped : {ahead(2.0), ahead(15.0), ahead(0.3) * Pose2{0.0, 0.0, kPi / 2}}) {
    tracker.start(view_at(ahead(0.0)));
    EXPECT_TRUE(tracker.follow(*view_at(ahead(0.05), 2)));
    EXPECT_FALSE(tracker.follow(*view_at(jumped, 3)));
  }
  tracker.start(view_at(ahead(0.0)));
  EXPECT_FALSE(tracker.follow(test::view_from(test::strange_place(3), {}))) << "another place altogether";
  EXPECT_FALSE(tracker.follow(test::view_of(test::blind_scan())));
}

TEST(ScanTracker, WithoutAKeyframeOrWithAStepOfNoneAttachesNothing) {
  MappingOptions options;
  ScanTracker tracker(options.robust);
  EXPECT_FALSE(tracker.follow(*view_at(ahead(0.0))));
  tracker.start(view_at(ahead(0.0)));
  EXPECT_TRUE(tracker.follow(*view_at(ahead(0.0))));
  tracker.start(nullptr);
  EXPECT_FALSE(tracker.follow(*view_at(ahead(0.0)))) << "another log starts";
  options.robust.keyframes.step_m = 0.0;
  tracker.start(view_at(ahead(0.0)));
  EXPECT_FALSE(tracker.follow(*view_at(ahead(0.0))));
}

TEST(ScanTracker, ExpectsNothingWhenAnotherSessionStarts) {
  const MappingOptions options;
  ScanTracker tracker(options.robust);
  tracker.start(view_at(ahead(0.0)));
  for (unsigned k = 1; k <= 40; ++k) ASSERT_TRUE(tracker.follow(*view_at(ahead(0.01 * k), k)));
  ASSERT_TRUE(tracker.expected());
  tracker.start(nullptr);
  tracker.start(view_at(ahead(8.0)));
  tracker.follow(*view_at(ahead(8.02)));
  EXPECT_FALSE(tracker.expected()) << "nobody knows yet how close its scans are";
}

/// The motion in another session is no evidence.
TEST(ScanTracker, ForgetsTheMotionWhenAnotherSessionStarts) {
  const MappingOptions options;
  ScanTracker used(options.robust);
  used.start(view_at(ahead(0.0)));
  for (unsigned k = 1; k <= 4; ++k) ASSERT_TRUE(used.follow(*view_at(ahead(0.09 * k), k)));
  ScanTracker fresh(options.robust);
  for (ScanTracker* tracker : {&used, &fresh}) {
    tracker->start(nullptr);
    EXPECT_FALSE(tracker->follow(*view_at(ahead(8.0))));
    tracker->start(view_at(ahead(8.0)));
  }
  const ScanView next = test::view_from(test::ring_world(1), ahead(8.02));
  const auto expected = fresh.follow(next);
  const auto found = used.follow(next);
  ASSERT_TRUE(expected && found);
  EXPECT_THAT(found->ref_from_query, test::HasSameBits(expected->ref_from_query));
}

/// The motion does not end at a keyframe.
TEST(ScanTracker, ExpectsTheMotionToGoOnAfterAKeyframe) {
  const MappingOptions options;
  ScanTracker tracker(options.robust);
  tracker.start(view_at(ahead(0.0)));
  double along_m = 0.0;
  unsigned k = 1;
  do {
    along_m += 0.08;
    ++k;
  } while (tracker.follow(*view_at(ahead(along_m), k)));
  tracker.start(view_at(ahead(along_m), k));
  for (unsigned more = 1; more <= 40; ++more) {  // until scans follow each other closely
    if (!tracker.follow(*view_at(ahead(along_m + 0.002 * more), k + more))) break;
  }
  tracker.start(view_at(ahead(along_m)));
  ASSERT_TRUE(tracker.follow(*view_at(ahead(along_m + 0.07), 90)));
  ASSERT_TRUE(tracker.follow(*view_at(ahead(along_m + 0.14), 91)));
  tracker.start(view_at(ahead(along_m + 0.14), 91));
  EXPECT_FALSE(tracker.follow(test::view_from(test::strange_place(3), {})));
  ASSERT_TRUE(tracker.expected());
  const Pose2 onward = inverse(ahead(along_m + 0.14)) * ahead(along_m + 0.21);
  EXPECT_THAT(tracker.expected()->pose, IsNearPose(onward, 0.05, 2 * kDegree));
  EXPECT_FALSE(tracker.follow(test::view_from(test::strange_place(3), {})));
  ASSERT_TRUE(tracker.expected());
  EXPECT_THAT(tracker.expected()->pose, test::HasSameBits(Pose2{})) << "nobody knows";
}

TEST(ScanTracker, LearnsHowNearScansAreToWhereTheyWereToBeExpected) {
  const MappingOptions options;
  ScanTracker tracker(options.robust);
  std::vector<double> usual_m;
  double along_m = 0.0;
  tracker.start(view_at(ahead(along_m)));
  for (unsigned k = 1; k <= 80; ++k) {
    along_m += 0.05;
    if (!tracker.follow(*view_at(ahead(along_m), k))) tracker.start(view_at(ahead(along_m), k));
    if (tracker.expected()) usual_m.push_back(tracker.expected()->usual_m);
  }
  ASSERT_GT(usual_m.size(), 30U);
  EXPECT_EQ(usual_m.front(), kUsualSurprise_m);
  EXPECT_LT(usual_m.back(), 0.5 * kUsualSurprise_m);
  tracker.forget_motion();
  tracker.follow(*view_at(ahead(along_m)));
  EXPECT_EQ(tracker.expected()->usual_m, kUsualSurprise_m) << "the motion may have been any";
  tracker.start(nullptr);
  tracker.start(view_at(ahead(0.0)));
  for (unsigned k = 1; k <= 40; ++k) ASSERT_TRUE(tracker.follow(*view_at(ahead(0.011 * k), k)));
  ASSERT_TRUE(tracker.expected());
  EXPECT_EQ(tracker.expected()->usual_m, kUsualSurprise_m) << "another log";
}

TEST(ScanTracker, LearnsNothingWhileTheSensorStands) {
  const MappingOptions options;
  ScanTracker tracker(options.robust);
  tracker.start(view_at(ahead(0.0)));
  for (unsigned k = 1; k <= 80; ++k) ASSERT_TRUE(tracker.follow(*view_at(ahead(0.0))));
  ASSERT_TRUE(tracker.expected());
  EXPECT_EQ(tracker.expected()->usual_m, kUsualSurprise_m);
}

Log dense_log(std::size_t count) {
  Log log;
  const test::World world = test::ring_world(1);
  std::mt19937 rng(7);
  for (std::size_t i = 0; i < count; ++i) {
    log.scans.push_back(test::scan_of(world, ahead(0.07 * static_cast<double>(i)), test::full_circle(), rng));
  }
  return log;
}

std::size_t num_keyframes(const MapResult& result) {
  std::size_t count = 0;
  for (const ScanResult& scan : result.scans) count += scan.is_keyframe ? 1 : 0;
  return count;
}

TEST(ScanTracker, OfADenseLogFewScansAreKeyframesAndAllHaveAPose) {
  constexpr std::size_t kCount = 48;
  const Log log = dense_log(kCount);
  MappingEvents nobody;
  MappingOptions options;
  const MapResult result = map_log(log, options, nobody);
  EXPECT_LE(num_keyframes(result), kCount / 5);
  EXPECT_GE(num_keyframes(result), 0.07 * kCount / 0.6);
  ASSERT_EQ(result.placed().size(), kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    EXPECT_EQ(result.placed()[i].scan_index, i);
    const Pose2 expected = inverse(ahead(0.0)) * ahead(0.07 * static_cast<double>(i));
    EXPECT_THAT(result.placed()[i].map_from_robot, IsNearPose(expected, 0.10, 2 * kDegree)) << i;
    EXPECT_EQ(result.why_not_in_map(result.scans[i]), "");
  }
  options.robust.keyframes.step_m = 0.0;
  options.robust.loops.close_loops = false;
  Log few = log;
  few.scans.resize(10);
  EXPECT_EQ(num_keyframes(map_log(few, options, nobody)), 10U);
}

}  // namespace
}  // namespace shapemap
