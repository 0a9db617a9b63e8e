// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/scan_matcher.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/matchers.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::IsNanPose;
using test::IsNearPose;

bool is_right(const ScanMatch& match, const Pose2& truth) {
  return match.has_pose() && (match.ref_from_query.translation() - truth.translation()).norm() < 0.10 &&
         angle_between(match.ref_from_query.theta_rad, truth.theta_rad) < 2 * kDegree;
}

TEST(MatchScans, FindsAnyHeadingAndOffsetInAFurnishedRoom) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int num_right = 0;
  int num_sure = 0;
  int num_sure_and_wrong = 0;
  for (int k = 0; k < 144; ++k) {
    const test::World world = test::cluttered_room(static_cast<unsigned>(k) / 24);
    const ScanView reference = test::view_from(world, {0.3 * unit(rng), 0.3 * unit(rng), 0.0}, test::full_circle(), 1);
    const Pose2 world_from_reference{0.3 * unit(rng), 0.3 * unit(rng), unit(rng)};
    const ScanView seen = test::view_from(world, world_from_reference, test::full_circle(), 2);
    const Pose2 world_from_query{0.9 * unit(rng), 0.9 * unit(rng), 5.0 * k * kDegree};
    const ScanView query = test::view_from(world, world_from_query, test::full_circle(), 3);
    const ScanMatch found = match_scans(seen, query, {});
    const bool right = is_right(found, inverse(world_from_reference) * world_from_query);
    num_right += right ? 1 : 0;
    num_sure += found.ok() ? 1 : 0;
    num_sure_and_wrong += found.ok() && !right ? 1 : 0;
  }
  EXPECT_GE(num_right, 140);
  EXPECT_GE(num_sure, 100);
  EXPECT_LE(num_sure_and_wrong, 1);
}

TEST(MatchScans, FindsAHalfCirclesNeighbour) {
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int num_right = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const test::World world = test::cluttered_room(seed, 5);
    const Pose2 truth{0.5 * unit(rng), 0.5 * unit(rng), 40 * kDegree * unit(rng)};
    const ScanView reference = test::view_from(world, {}, test::half_circle(), 1);
    const ScanView query = test::view_from(world, truth, test::half_circle(), 2);
    num_right += is_right(match_scans(reference, query, {}), truth) ? 1 : 0;
  }
  EXPECT_GE(num_right, 34);
}

TEST(MatchScans, IsNotSureOfTwoPlacesWithNothingInCommon) {
  int num_sure = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const ScanView here = test::view_from(test::strange_place(seed), {}, test::full_circle(), 1);
    const ScanView there = test::view_from(test::strange_place(1000 + seed), {}, test::full_circle(), 2);
    num_sure += match_scans(here, there, {}).ok() ? 1 : 0;
  }
  EXPECT_LE(num_sure, 1);
}

TEST(MatchScans, IsNotSureWhereAlongABareCorridorItStands) {
  test::Scanner scanner = test::half_circle();
  scanner.max_range_m = 8.0;
  const ScanView reference = test::view_from(test::bare_corridor(), {}, scanner, 1);
  const ScanView query = test::view_from(test::bare_corridor(), {0.7, 0.0, 0.0}, scanner, 2);
  EXPECT_FALSE(match_scans(reference, query, {}).ok());
}

TEST(MatchScans, SaysWhyThereIsNoPose) {
  const ScanView nothing = test::view_of(test::blind_scan());
  const ScanView room = test::view_from(test::cluttered_room(1), {});
  for (const ScanMatch& match :
       {match_scans(nothing, room, {}), match_scans(room, nothing, {}), match_scans(nothing, nothing, {})}) {
    EXPECT_EQ(match.status, MatchStatus::kNoCandidates);
    EXPECT_FALSE(match.has_pose());
    EXPECT_THAT(match.ref_from_query, IsNanPose());
    EXPECT_FALSE(match.reason.empty());
  }
}

void expect_consistent(const ScanMatch& match) {
  const Pose2& pose = match.ref_from_query;
  if (match.has_pose()) {
    EXPECT_TRUE(std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.theta_rad));
    EXPECT_TRUE(match.probability >= 0.0 && match.probability <= 1.0);
    EXPECT_TRUE(match.covariance.allFinite());
    ASSERT_FALSE(match.ranked.empty());
    EXPECT_THAT(match.ranked[0].ref_from_query, HasSameBits(pose));
  } else {
    EXPECT_THAT(pose, IsNanPose());
  }
  EXPECT_EQ(match.ok(), match.reason.empty()) << match.reason;
  for (const RankedPose& ranked : match.ranked) {
    EXPECT_TRUE(ranked.agree >= 0.0 && ranked.crossed >= 0.0 && ranked.agree + ranked.crossed <= 1.0 + 1e-9);
    EXPECT_TRUE(std::isfinite(ranked.score));
  }
}

TEST(MatchScans, TakesScansOfOneBeamOrWithReadingsThatAreNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const ScanView room = test::view_from(test::cluttered_room(1), {});
  for (const std::vector<float>& ranges_m : {std::vector<float>{2.0F},
                                             {nan},
                                             {infinity, -infinity},
                                             {2.0F, 2.0F},
                                             {2.0F, nan, 2.1F},
                                             {0.0F, -1.0F, 1e30F},
                                             std::vector<float>(180, 1e-6F),
                                             std::vector<float>(180, 999.0F),
                                             std::vector<float>(180, 1.0F)}) {
    Scan scan;
    Sweep sweep;
    sweep.ranges_m = ranges_m;
    sweep.first_angle_rad = -1.0;
    sweep.angle_step_rad = kDegree;
    scan.sweeps.push_back(sweep);
    const ScanView odd = test::view_of(scan);
    expect_consistent(match_scans(odd, room, {}));
    expect_consistent(match_scans(room, odd, {}));
    expect_consistent(match_scans(odd, odd, {}));
  }
  expect_consistent(match_scans(test::view_of(Scan{}), room, {}));
}

TEST(MatchScans, FindsThePoseAlthoughSomeReadingsAreNone) {
  const test::World world = test::cluttered_room(1);
  std::mt19937 rng(3);
  const Pose2 truth{0.4, 0.2, 1.0};
  Scan query = test::scan_of(world, truth, test::full_circle(), rng);
  for (std::size_t k = 0; k < query.sweeps[0].ranges_m.size(); k += 4) query.sweeps[0].ranges_m[k] = std::nanf("");
  const ScanMatch found = match_scans(test::view_from(world, {}), test::view_of(query), {});
  expect_consistent(found);
  EXPECT_TRUE(is_right(found, truth));
}

TEST(MatchScans, TurnsWithTheQuery) {
  const test::World world = test::cluttered_room(2);
  const ScanView reference = test::view_from(world, {});
  std::mt19937 rng(4);
  const Scan query = test::scan_of(world, {0.5, -0.2, 0.3}, test::full_circle(), rng);
  const ScanMatch found = match_scans(reference, test::view_of(query), {});
  ASSERT_TRUE(found.has_pose());
  for (int k = 1; k < 24; ++k) {
    const double turn_rad = 15.3 * k * kDegree;
    const Pose2 turn{0.0, 0.0, turn_rad};
    const ScanMatch turned = match_scans(reference, test::view_of(test::turned(query, turn_rad)), {});
    ASSERT_TRUE(turned.has_pose());
    // The grid of the votes is not turned, so that the refinement starts at another pose.
    EXPECT_THAT(turned.ref_from_query * turn, IsNearPose(found.ref_from_query, 0.02, 0.5 * kDegree)) << k;
  }
}

TEST(MatchScans, TurnsWithTheReference) {
  const test::World world = test::cluttered_room(2);
  std::mt19937 rng(4);
  const Scan reference = test::scan_of(world, {0.1, 0.2, 0.0}, test::full_circle(), rng);
  const ScanView query = test::view_from(world, {0.5, -0.2, 0.3}, test::full_circle(), 2);
  const ScanMatch found = match_scans(test::view_of(reference), query, {});
  ASSERT_TRUE(found.has_pose());
  for (int k = 1; k < 12; ++k) {
    const double turn_rad = 31.7 * k * kDegree;
    const ScanMatch turned = match_scans(test::view_of(test::turned(reference, turn_rad)), query, {});
    ASSERT_TRUE(turned.has_pose());
    EXPECT_THAT(Pose2({0.0, 0.0, -turn_rad}) * turned.ref_from_query,
                IsNearPose(found.ref_from_query, 0.02, 0.5 * kDegree));
  }
}

TEST(MatchScans, IsTheSameToTheBitTheSecondTime) {
  const ScanView reference = test::view_from(test::cluttered_room(2), {});
  const ScanView query = test::view_from(test::cluttered_room(2), {0.5, -0.2, 0.3}, test::full_circle(), 2);
  const ScanMatch once = match_scans(reference, query, {});
  const ScanMatch again = match_scans(reference, query, {});
  EXPECT_THAT(again.ref_from_query, HasSameBits(once.ref_from_query));
  EXPECT_EQ(again.probability, once.probability);
  EXPECT_EQ(again.ranked.size(), once.ranked.size());
}

/// Returns a candidate that is constrained in all directions and with which most points agree.
MatchCandidate good_candidate(const Pose2& pose, double score) {
  MatchCandidate candidate;
  candidate.ref_from_query = pose;
  candidate.score = score;
  candidate.visibility.agree = 9.0;
  candidate.visibility.hidden = 1.0;
  candidate.fit.partners = 100;
  candidate.fit.lever_m = 2.0;
  candidate.fit.information.diagonal() << 50.0, 50.0, 200.0;
  return candidate;
}

TEST(Judged, RanksTheChosenOneFirst) {
  const std::vector<MatchCandidate> poses{good_candidate({1, 0, 0}, 4.0), good_candidate({2, 0, 0}, 3.0),
                                          good_candidate({3, 0, 0}, 2.0), good_candidate({4, 0, 0}, 2.5)};
  const ScanMatch match = judged(poses, 1, 1.5, {0.0, 0.0, 10.0});
  EXPECT_TRUE(match.ok());
  EXPECT_THAT(match.ref_from_query, HasSameBits(Pose2{2, 0, 0}));
  std::vector<double> places_m;
  for (const RankedPose& ranked : match.ranked) places_m.push_back(ranked.ref_from_query.x_m);
  EXPECT_EQ(places_m, (std::vector<double>{2.0, 1.0, 4.0, 3.0})) << "and the others best first";
  EXPECT_DOUBLE_EQ(match.ranked[0].agree, 0.9);
  EXPECT_EQ(match.probability, match_probability(poses[1], 1.5));
  expect_consistent(match);
}

TEST(Judged, TakesTheProbabilityThatIsKnownBetter) {
  const std::vector<MatchCandidate> good{good_candidate({1, 0, 0}, 4.0)};
  EXPECT_EQ(judged(good, 0, kFullMargin, {0.5, 0.0, 10.0}, 0.75).probability, 0.75);
  EXPECT_EQ(judged(good, 0, kFullMargin, {0.5, 0.0, 10.0}, 0.75).status, MatchStatus::kOk);
  EXPECT_EQ(judged(good, 0, kFullMargin, {0.5, 0.0, 10.0}, 0.25).status, MatchStatus::kAmbiguous);
}

TEST(Judged, GivesEachVerdictForItsReason) {
  const std::vector<MatchCandidate> good{good_candidate({1, 0, 0}, 4.0)};
  EXPECT_EQ(judged(good, 0, kFullMargin, {1.0, 0.0, 10.0}).status, MatchStatus::kAmbiguous);
  EXPECT_EQ(judged(good, 0, kFullMargin, {0.0, 0.95, 10.0}).status, MatchStatus::kTooLittleOverlap);
  EXPECT_EQ(judged({}, 0, 0.0, {}).status, MatchStatus::kNoCandidates);
  std::vector<MatchCandidate> sliding = good;
  sliding[0].fit.information(0, 0) = 0.0;
  EXPECT_EQ(judged(sliding, 0, kFullMargin, {0.0, 0.0, 0.5}).status, MatchStatus::kDegenerate);
  EXPECT_EQ(judged(good, 0, kFullMargin, {0.0, 0.0, 0.5}).status, MatchStatus::kOk);
  for (const ConfidenceOptions& options :
       {ConfidenceOptions{1.0, 0.0, 10.0}, ConfidenceOptions{0.0, 0.95, 10.0}, ConfidenceOptions{0.0, 0.0, 0.5}}) {
    expect_consistent(judged(good, 0, kFullMargin, options));
    expect_consistent(judged(sliding, 0, kFullMargin, options));
  }
}

}  // namespace
}  // namespace shapemap
