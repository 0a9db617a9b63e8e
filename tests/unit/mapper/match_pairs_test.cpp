// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/match_pairs.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "shapemap/core/errors.hpp"
#include "support/matchers.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::IsNearPose;

/// Returns poses with large turns.
const std::vector<Pose2> kPoses{{-0.4, 0.1, 0.0}, {0.0, -0.2, 70 * kDegree}, {0.5, 0.1, -120 * kDegree}};

Log log_of(const std::vector<Pose2>& poses) {
  Log log;
  for (const Pose2& pose : poses) log.scans.push_back(test::scan_of(test::cluttered_room(3), pose));
  return log;
}

Pose2 true_pose(std::size_t reference, std::size_t query) { return inverse(kPoses[reference]) * kPoses[query]; }

std::vector<AlignedPair> aligned(const Log& log, const std::vector<ScanPair>& pairs, int threads = 1) {
  MappingOptions options;
  options.run.threads = threads;
  RunObserver nobody;
  return align_pairs(log, log, pairs, options, nobody);
}

std::vector<ScanPair> all_pairs(std::size_t times) {
  std::vector<ScanPair> pairs;
  for (std::size_t k = 0; k < times; ++k) {
    for (std::size_t i = 0; i < kPoses.size(); ++i) {
      for (std::size_t j = 0; j < kPoses.size(); ++j) pairs.push_back({i, j, {}});
    }
  }
  return pairs;
}

TEST(AlignPairs, FindsEveryPair) {
  for (const AlignedPair& result : aligned(log_of(kPoses), all_pairs(1))) {
    EXPECT_EQ(result.match.status, MatchStatus::kOk) << result.match.reason;
    const Pose2 truth = true_pose(result.pair.reference, result.pair.query);
    EXPECT_THAT(result.match.ref_from_query, IsNearPose(truth, 0.03, 1 * kDegree));
    EXPECT_FALSE(result.given);
    EXPECT_FALSE(result.refined);
  }
}

TEST(AlignPairs, AreTheSameForAnyNumberOfThreadsAndWhateverCameBefore) {
  const Log log = log_of(kPoses);
  const std::vector<ScanPair> pairs = all_pairs(5);  // more pairs than are worked on together
  const std::vector<AlignedPair> one = aligned(log, pairs, 1);
  const std::vector<AlignedPair> three = aligned(log, pairs, 3);
  ASSERT_EQ(one.size(), pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(one[i].pair.reference, pairs[i].reference);
    EXPECT_EQ(one[i].pair.query, pairs[i].query);
    EXPECT_THAT(one[i].match.ref_from_query, HasSameBits(three[i].match.ref_from_query));
    EXPECT_THAT(one[i].match.ref_from_query, HasSameBits(one[i % 9].match.ref_from_query));
    EXPECT_EQ(one[i].match.probability, three[i].match.probability);
  }
}

TEST(AlignPairs, JudgesAGivenPoseAsItIsAndRefined) {
  const Pose2 truth = true_pose(0, 1);
  const Pose2 off{truth.x_m + 0.08, truth.y_m, truth.theta_rad};
  const std::vector<AlignedPair> results = aligned(log_of(kPoses), {{0, 1, truth}, {0, 1, off}, {0, 1, {}}});
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(results[i].given);
    ASSERT_TRUE(results[i].refined);
    EXPECT_THAT(results[i].given->ref_from_query, HasSameBits(*results[i].pair.given_ref_from_query));
    EXPECT_THAT(results[i].refined->ref_from_query, IsNearPose(truth, 0.03, 1 * kDegree));
    EXPECT_THAT(results[i].match.ref_from_query, HasSameBits(results[2].match.ref_from_query));
    EXPECT_GT(results[i].given->partners, 50);
    const RankedPose& given = *results[i].given;
    EXPECT_NEAR(given.agree + given.crossed + given.hidden + given.unclear + given.outside, 1.0, 1e-12);
  }
  EXPECT_GT(results[0].given->score, results[1].given->score);
  EXPECT_GT(results[1].given->rms_m, results[0].given->rms_m);
  EXPECT_LT(results[1].refined->rms_m, results[1].given->rms_m);
}

TEST(AlignPairs, SayWhichScanHasNoShape) {
  Log log = log_of(kPoses);
  for (float& range_m : log.scans[1].sweeps[0].ranges_m) range_m = std::nanf("");
  const std::vector<AlignedPair> results = aligned(log, {{0, 1, Pose2{}}, {1, 0, {}}});
  for (const AlignedPair& result : results) {
    EXPECT_EQ(result.match.status, MatchStatus::kNoShape);
    EXPECT_FALSE(result.given);
    EXPECT_TRUE(result.match.ranked.empty());
  }
  EXPECT_THAT(results[0].match.reason, ::testing::StartsWith("the query has only 0 shape points"));
  EXPECT_THAT(results[1].match.reason, ::testing::StartsWith("the reference has only 0 shape points"));
}

TEST(AlignPairs, RefuseAnIndexBeyondItsLog) {
  const Log log = log_of(kPoses);
  const Log short_log = log_of({kPoses[0]});
  RunObserver nobody;
  EXPECT_NO_THROW(align_pairs(log, short_log, {{2, 0, {}}}, {}, nobody));
  EXPECT_THROW(align_pairs(log, short_log, {{0, 2, {}}}, {}, nobody), ConfigError);
  EXPECT_THROW(align_pairs(log, log, {{3, 0, {}}}, {}, nobody), ConfigError);
}

TEST(AlignPairs, TellProgressAndStopWhenAsked) {
  struct Stopper : RunObserver {
    void on_progress(std::size_t now_done, std::size_t /*total*/) override { done = now_done; }
    bool keep_going() override { return done == 0; }
    std::size_t done = 0;
  } stopper;
  const Log log = log_of(kPoses);
  EXPECT_THROW(align_pairs(log, log, all_pairs(8), {}, stopper), Interrupted);
  EXPECT_GT(stopper.done, 0U);
  EXPECT_LT(stopper.done, 72U);
}

TEST(PairsWithGap, AreAllThatFit) {
  EXPECT_EQ(pairs_with_gap(4, 1).size(), 3U);
  EXPECT_EQ(pairs_with_gap(4, 3).size(), 1U);
  EXPECT_EQ(pairs_with_gap(4, 3).front().query, 3U);
  EXPECT_TRUE(pairs_with_gap(4, 4).empty());
  EXPECT_TRUE(pairs_with_gap(0, 1).empty());
  EXPECT_TRUE(pairs_with_gap(4, static_cast<std::size_t>(-1)).empty());
}

}  // namespace
}  // namespace shapemap
