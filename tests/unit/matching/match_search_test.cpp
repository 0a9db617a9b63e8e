// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/match_search.hpp"

#include <gmock/gmock.h>

#include <random>

#include "support/matchers.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::IsNearPose;
using ::testing::IsEmpty;

MatchCandidate at(const Pose2& pose, double score) {
  MatchCandidate candidate;
  candidate.ref_from_query = pose;
  candidate.score = score;
  return candidate;
}

bool near(const Pose2& a, const Pose2& b, double distance_m, double angle_rad) {
  return (a.translation() - b.translation()).norm() < distance_m && angle_between(a.theta_rad, b.theta_rad) < angle_rad;
}

TEST(BestDistinct, KeepsTheBestOfEachPlaceBestFirst) {
  const std::vector<MatchCandidate> best = best_distinct(
      {at({0, 0, 0}, 1.0), at({2, 0, 0}, 5.0), at({0.01, 0, 0}, 3.0), at({2, 0, 0.01}, 4.0), at({0, 0, kPi}, 2.0)}, 10);
  ASSERT_EQ(best.size(), 3U);
  EXPECT_THAT(best[0].ref_from_query, HasSameBits(Pose2{2, 0, 0}));
  EXPECT_THAT(best[1].ref_from_query, HasSameBits(Pose2{0.01, 0, 0}));
  EXPECT_THAT(best[2].ref_from_query, HasSameBits(Pose2{0, 0, kPi}));
}

TEST(BestDistinct, KnowsOneHeadingOnEitherSideOfTheFullTurn) {
  EXPECT_EQ(best_distinct({at({0, 0, kPi - 0.01}, 1.0), at({0, 0, -kPi + 0.01}, 2.0)}, 5).size(), 1U);
}

TEST(BestDistinct, OfEqualScoresTheFirstWins) {
  const std::vector<MatchCandidate> best = best_distinct({at({1, 0, 0}, 1.0), at({1.01, 0, 0}, 1.0)}, 5);
  ASSERT_EQ(best.size(), 1U);
  EXPECT_THAT(best[0].ref_from_query, HasSameBits(Pose2{1, 0, 0}));
}

TEST(BestDistinct, OfManyAreApartAndCoverAllOthers) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int round = 0; round < 50; ++round) {
    std::vector<MatchCandidate> all;
    for (int k = 0; k < 60; ++k) all.push_back(at({unit(rng), unit(rng), kPi * unit(rng)}, unit(rng)));
    const std::vector<MatchCandidate> best = best_distinct(all, 60);
    for (std::size_t i = 0; i < best.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_GE(best[k].score, best[i].score);
        EXPECT_FALSE(near(best[i].ref_from_query, best[k].ref_from_query, 0.05, kDegree));
      }
    }
    for (const MatchCandidate& pose : all) {
      const bool covered = std::any_of(best.begin(), best.end(), [&](const MatchCandidate& kept) {
        return kept.score >= pose.score && near(kept.ref_from_query, pose.ref_from_query, 0.5, 10 * kDegree);
      });
      EXPECT_TRUE(covered);
    }
    const std::vector<MatchCandidate> three = best_distinct(all, 3);
    ASSERT_EQ(three.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_THAT(three[i].ref_from_query, HasSameBits(best[i].ref_from_query));
  }
}

TEST(BestDistinct, OfNoneIsNone) { EXPECT_THAT(best_distinct({}, 5), IsEmpty()); }

TEST(FindCandidates, AreDistinctBestFirstAndNoMoreThanAreKept) {
  const ScanView reference = test::view_from(test::cluttered_room(1), {});
  const ScanView query = test::view_from(test::cluttered_room(1), {0.5, 0.3, 2.0}, test::full_circle(), 2);
  for (const int kept : {1, 3, 10}) {
    MatchSearchOptions options;
    options.candidates.kept = kept;
    const std::vector<MatchCandidate> poses = find_candidates(reference, query, options);
    ASSERT_FALSE(poses.empty());
    EXPECT_LE(poses.size(), static_cast<std::size_t>(kept));
    EXPECT_THAT(poses[0].ref_from_query, IsNearPose(Pose2{0.5, 0.3, 2.0}, 0.05, kDegree));
    for (std::size_t i = 1; i < poses.size(); ++i) {
      EXPECT_GE(poses[i - 1].score, poses[i].score);
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_FALSE(near(poses[i].ref_from_query, poses[k].ref_from_query, 0.05, kDegree));
      }
    }
  }
}

TEST(FindCandidates, FindAPoseWithoutHelpOfTangentPeaks) {
  const ScanView reference = test::view_from(test::cluttered_room(2), {});
  const ScanView query = test::view_from(test::cluttered_room(2), {0.4, -0.2, -1.3}, test::full_circle(), 2);
  MatchSearchOptions options;
  options.candidates.rotation_peaks = 1;
  options.candidates.all_rotations_below = 100.0;  // no score suffices, so that all rotations are tried
  const std::vector<MatchCandidate> poses = find_candidates(reference, query, options);
  ASSERT_FALSE(poses.empty());
  EXPECT_THAT(poses[0].ref_from_query, IsNearPose(Pose2{0.4, -0.2, -1.3}, 0.05, kDegree));
}

TEST(FindCandidates, WithAnEmptyScanAreNone) {
  const ScanView nothing = test::view_of(test::blind_scan());
  const ScanView room = test::view_from(test::cluttered_room(2), {});
  EXPECT_THAT(find_candidates(nothing, room, {}), IsEmpty());
  EXPECT_THAT(find_candidates(room, nothing, {}), IsEmpty());
  EXPECT_THAT(find_candidates(nothing, nothing, {}), IsEmpty());
  EXPECT_THAT(find_candidates(ScanView{}, ScanView{}, {}), IsEmpty());
}

TEST(RefinedCandidate, IsJudgedWhereItEndsUp) {
  const ScanView reference = test::view_from(test::cluttered_room(3), {});
  const ScanView query = test::view_from(test::cluttered_room(3), {0.2, 0.1, 0.3}, test::full_circle(), 2);
  const MatchCandidate pose = refined_candidate(reference, query, {0.3, 0.2, 0.35}, {});
  EXPECT_THAT(pose.ref_from_query, IsNearPose(Pose2{0.2, 0.1, 0.3}, 0.03, kDegree));
  EXPECT_THAT(pose.ref_from_query, HasSameBits(pose.fit.ref_from_query));
  EXPECT_EQ(pose.visibility.agree, visibility(reference, query, pose.ref_from_query, {}).agree);
  EXPECT_LE(pose.score, visibility_score(pose.visibility));
}

}  // namespace
}  // namespace shapemap
