// SPDX-License-Identifier: GPL-3.0-or-later
// A robot goes round a ring twice, and is localized in the map of the first lap.
#include "localization/revisit_tracking.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "localization/localization_numbers.hpp"
#include "mapper/keyframe_culling.hpp"
#include "shapemap/inference/map_search.hpp"
#include "support/matchers.hpp"
#include "support/ring_laps.hpp"

namespace shapemap {
namespace {

using test::KnownGraph;
using test::Laps;

constexpr std::size_t kSettled = test::kRingLap + 6;

/// The robot does not sway, so that most places are recognised.
Laps steady_laps(std::size_t count) {
  std::vector<Pose2> poses;
  std::mt19937 rng(5);
  for (std::size_t i = 0; i < count; ++i) {
    poses.push_back(test::on_ring(test::kRingStep_m * static_cast<double>(i)) * test::random_pose(rng, 0.05, 0.05));
  }
  return Laps(poses);
}

const Laps& two_laps() {
  static const Laps laps = steady_laps(2 * test::kRingLap);
  return laps;
}

const MappingOptions& quick() {
  static const MappingOptions options = test::quick_mapping();
  return options;
}

/// Follows the keyframes after the first `num_settled`, whose poses in the map are right.
RevisitTracker::Followed followed(const Laps& laps, const KnownGraph& known,
                                  const std::vector<EdgeCandidate>& loops = {}, std::size_t num_settled = kSettled) {
  const MappingOptions options = quick();
  RevisitTracker revisits(options.robust);
  OptimizedMap map = known.map;
  std::copy(laps.truth.begin(), laps.truth.begin() + static_cast<std::ptrdiff_t>(num_settled),
            map.map_from_keyframe.begin());
  revisits.start(known.graph, map, num_settled);
  return revisits.follow(known.graph, loops);
}

std::size_t num_known(const RevisitTracker::Followed& followed, std::size_t first = 0) {
  return static_cast<std::size_t>(std::count_if(followed.redundant.begin() + static_cast<std::ptrdiff_t>(first),
                                                followed.redundant.end(), [](const auto& s) { return s.has_value(); }));
}

/// The last few keyframes are never followed, and the localization of those just before them is not certain yet.
std::size_t end_of_followed(const Laps& laps) {
  return laps.truth.size() - kLocalization.redundancy.keyframes_in_use - 12;
}

/// Returns the poses with an error added to each step.
std::vector<Pose2> drifting(const std::vector<Pose2>& truth, const Pose2& error) {
  std::vector<Pose2> poses{truth.front()};
  for (std::size_t i = 1; i < truth.size(); ++i) {
    poses.push_back(poses.back() * (inverse(truth[i - 1]) * truth[i]) * error);
  }
  return poses;
}

/// Returns a graph whose edge to keyframe `b` is off by `error`.
KnownGraph wrong_at(const Laps& laps, std::size_t b, const Pose2& error) {
  std::vector<Pose2> poses = laps.truth;
  for (std::size_t i = b; i < poses.size(); ++i) {
    poses[i] = poses[b - 1] * error * (inverse(laps.truth[b - 1]) * laps.truth[i]);
  }
  return {laps, poses};
}

/// Returns the same graph with this edge in doubt.
KnownGraph doubtful_at(const Laps& laps, std::size_t b, const Pose2& error) {
  KnownGraph known = wrong_at(laps, b, error);
  known.graph.edges[b - 1].choice.margin = 0.01;  // makes the edge doubtful
  return known;
}

TEST(RevisitTracker, KnowThePlacesOfTheLapBefore) {
  const Laps& laps = two_laps();
  const RevisitTracker::Followed result = followed(laps, KnownGraph(laps));
  ASSERT_EQ(result.redundant.size(), laps.truth.size());
  EXPECT_EQ(result.num_followed, end_of_followed(laps));
  EXPECT_GT(num_known(result), (result.num_followed - kSettled) * 3 / 4);
  EXPECT_EQ(num_known(result, result.num_followed), 0U);
  for (std::size_t b = 0; b < laps.truth.size(); ++b) {
    EXPECT_THAT(result.map.map_from_keyframe[b], test::IsNearPose(laps.truth[b], 0.10, 2 * kDegree)) << b;
    if (!result.redundant[b]) continue;
    const ReplacementKeyframe& replacement = *result.redundant[b];
    EXPECT_LT(replacement.keyframe, kSettled);
    EXPECT_THAT(result.map.map_from_keyframe[replacement.keyframe] * replacement.pose.ref_from_query,
                test::IsNearPose(laps.truth[b], 0.08, 2 * kDegree));
  }
}

TEST(RevisitTracker, TakeTheErrorsOfOdometryAway) {
  const Laps& laps = two_laps();
  const Pose2 error{0.02, 0.01, 0.3 * kDegree};
  const std::vector<Pose2> drifted = drifting(laps.truth, error);
  const RevisitTracker::Followed result = followed(laps, KnownGraph(laps, drifted));
  const std::size_t last = result.num_followed - 1;
  const Pose2 by_odometry = laps.truth[kSettled - 1] * inverse(drifted[kSettled - 1]) * drifted[last];
  EXPECT_GT((by_odometry.translation() - laps.truth[last].translation()).norm(), 0.35);
  EXPECT_LT((result.map.map_from_keyframe[last].translation() - laps.truth[last].translation()).norm(), 0.2);
  EXPECT_GT(num_known(result), 6U);
}

TEST(RevisitTracker, BelieveADoubtfulEdgeWhenWhatComesAfterIsWhereItWasExpected) {
  const Laps& laps = two_laps();
  constexpr std::size_t kDoubtful = kSettled + 4;
  const KnownGraph known = doubtful_at(laps, kDoubtful, {});
  ASSERT_LT(edge_probability(known.graph.edges[kDoubtful - 1]), 0.6);
  const RevisitTracker::Followed result = followed(laps, known);
  EXPECT_EQ(num_known(result), num_known(followed(laps, KnownGraph(laps))));
  EXPECT_TRUE(result.map.loop_constrained[kDoubtful - 1]);
  EXPECT_EQ(result.map.component[result.num_followed - 1], 0U);
}

/// The graph chose the wrong one of two candidates.
TEST(RevisitTracker, TakeTheCandidateAfterWhichPlacesAreKnownAgain) {
  const Laps& laps = two_laps();
  constexpr std::size_t kWrong = kSettled + 4;
  KnownGraph known = doubtful_at(laps, kWrong, {0.7, 0.0, 5 * kDegree});
  std::vector<MatchCandidate>& candidates = known.graph.edges[kWrong - 1].candidates;
  candidates.push_back(candidates.front());
  candidates.back().ref_from_query = inverse(laps.truth[kWrong - 1]) * laps.truth[kWrong];
  const RevisitTracker::Followed result = followed(laps, known);
  EXPECT_EQ(result.map.edge_choice[kWrong - 1], 1);
  EXPECT_TRUE(result.map.loop_constrained[kWrong - 1]);
  EXPECT_EQ(num_known(result), num_known(followed(laps, KnownGraph(laps))));
  for (std::size_t b = 0; b < result.num_followed; ++b) {
    EXPECT_THAT(result.map.map_from_keyframe[b], test::IsNearPose(laps.truth[b], 0.10, 2 * kDegree)) << b;
  }
  for (const PoseConstraint& constraint : result.map.constraints) {
    const Pose2 truth = inverse(laps.truth[constraint.a]) * laps.truth[constraint.b];
    if (constraint.b >= result.num_followed) continue;
    EXPECT_THAT(constraint.a_from_b, test::IsNearPose(truth, 0.10, 2 * kDegree));
  }
}

TEST(RevisitTracker, TakeEitherOfTwoCandidatesThatAreOnePlace) {
  const Laps& laps = two_laps();
  constexpr std::size_t kDoubtful = kSettled + 4;
  KnownGraph known = doubtful_at(laps, kDoubtful, {0.7, 0.0, 5 * kDegree});
  std::vector<MatchCandidate>& candidates = known.graph.edges[kDoubtful - 1].candidates;
  for (const double off_m : {0.01, -0.01}) {
    candidates.push_back(candidates.front());
    candidates.back().ref_from_query =
        inverse(laps.truth[kDoubtful - 1]) * laps.truth[kDoubtful] * Pose2{off_m, 0.0, 0.0};
  }
  const RevisitTracker::Followed result = followed(laps, known);
  EXPECT_GT(result.map.edge_choice[kDoubtful - 1], 0);
  EXPECT_GT(num_known(result, kDoubtful), 10U);
}

TEST(RevisitTracker, KnowNothingAgainAfterAWrongEdge) {
  const Laps& laps = two_laps();
  constexpr std::size_t kWrong = kSettled + 4;
  const RevisitTracker::Followed result = followed(laps, doubtful_at(laps, kWrong, {0.7, 0.0, 5 * kDegree}));
  EXPECT_EQ(num_known(result, kWrong), 0U);
  EXPECT_FALSE(result.map.loop_constrained[kWrong - 1]);
  EXPECT_EQ(result.num_followed, kWrong);
  for (std::size_t b = kWrong; b < end_of_followed(laps); ++b) EXPECT_NE(result.map.component[b], 0U) << b;
}

/// Returns a candidate that joins keyframe `b` to the keyframe a lap ago.
EdgeCandidate loop_to(const Laps& laps, std::size_t b) {
  const std::size_t a = b - test::kRingLap;
  return {a, b, inverse(laps.truth[a]) * laps.truth[b], Eigen::Matrix3d::Identity() * 1e-4, 2.0};
}

TEST(RevisitTracker, FindTheWayAgainWhereALoopPutsIt) {
  const Laps& laps = two_laps();
  constexpr std::size_t kWrong = kSettled + 4;
  const KnownGraph known = doubtful_at(laps, kWrong, {0.7, 0.0, 5 * kDegree});
  EdgeCandidate wrong = loop_to(laps, kWrong + 7);
  wrong.a -= 5;
  wrong.score = 3.0;
  const RevisitTracker::Followed result = followed(laps, known, {wrong, loop_to(laps, kWrong + 9)});
  EXPECT_EQ(result.num_followed, laps.truth.size() - kLocalization.redundancy.keyframes_in_use);
  EXPECT_GE(num_known(result) + 2, num_known(followed(laps, KnownGraph(laps))));  // the two at the edge must stay
  for (std::size_t b = 0; b < result.num_followed; ++b) {
    EXPECT_EQ(result.map.component[b], 0U) << b;
    EXPECT_THAT(result.map.map_from_keyframe[b], test::IsNearPose(laps.truth[b], 0.10, 2 * kDegree)) << b;
  }
  EXPECT_EQ(result.map.edge_choice[kWrong - 1], kCut);  // no candidate is right
}

TEST(RevisitTracker, FindNoWayWhereALoopIsWrong) {
  const Laps& laps = two_laps();
  constexpr std::size_t kWrong = kSettled + 4;
  EdgeCandidate wrong = loop_to(laps, kWrong + 9);
  wrong.a -= 6;
  const RevisitTracker::Followed result = followed(laps, doubtful_at(laps, kWrong, {0.7, 0.0, 5 * kDegree}), {wrong});
  EXPECT_EQ(result.num_followed, kWrong);
  EXPECT_EQ(num_known(result, kWrong), 0U);
}

/// A wrong edge whose probability is high.
TEST(RevisitTracker, GetLostWhereSomethingElseIsSeen) {
  const Laps& laps = two_laps();
  constexpr std::size_t kWrong = kSettled + 4;
  KnownGraph known = wrong_at(laps, kWrong, {0.7, 0.0, 5 * kDegree});
  known.graph.edges[kWrong - 1].candidates =
      known.graph.edges[kWrong - 2].candidates;  // these state a high probability
  known.graph.edges[kWrong - 1].candidates.front().ref_from_query =
      inverse(laps.truth[kWrong - 1]) * laps.truth[kWrong] * Pose2{0.7, 0.0, 5 * kDegree};
  ASSERT_GE(stated_probability(known.graph.edges[kWrong - 1]), kLocalization.redundancy.sure_edge);
  const RevisitTracker::Followed result = followed(laps, known);
  EXPECT_LE(result.num_followed, kWrong + 2);
  EXPECT_EQ(num_known(result, kWrong), 0U);
}

/// Errors that add up in an unknown area must not make the robot lost, and its keyframes must stay.
TEST(RevisitTracker, GoOnWhereNobodyHasBeen) {
  const Laps& laps = two_laps();
  constexpr std::size_t kHalf = test::kRingLap / 2;
  const RevisitTracker::Followed result = followed(laps, KnownGraph(laps), {}, kHalf);
  EXPECT_EQ(result.num_followed, end_of_followed(laps));
  for (std::size_t b = kHalf; b + 2 < test::kRingLap; ++b) EXPECT_FALSE(result.redundant[b]) << b;
  EXPECT_GT(num_known(result), (end_of_followed(laps) - test::kRingLap) / 2);
  EXPECT_EQ(result.map.component[result.num_followed - 1], 0U);
}

/// An edge to a keyframe that is not certain yet stays as it is when the keyframe before it is culled.
TEST(RevisitTracker, LeaveTheEdgeToWhatComesNextAsItIs) {
  const Laps& laps = two_laps();
  constexpr std::size_t kWrong = kSettled + 4;
  for (const bool lost : {false, true}) {
    KnownGraph known = lost ? doubtful_at(laps, kWrong, {0.7, 0.0, 5 * kDegree}) : KnownGraph(laps);
    RevisitTracker::Followed result = followed(laps, known);
    const std::size_t next = laps.truth.size() - result.num_followed;
    LoopCandidates loops;
    cull_keyframes(result.redundant, quick(), result.map, known.graph, loops);
    const std::size_t first_open = known.graph.keyframes.size() - next;
    EXPECT_FALSE(known.graph.edges[first_open].culled_covariance);
    EXPECT_TRUE(!lost || !known.graph.edges[first_open - 1].culled_covariance);
  }
}

TEST(RevisitTracker, ForgiveAPlaceThatHasChanged) {
  const Laps& laps = two_laps();
  constexpr std::size_t kChanged = kSettled + 9;
  KnownGraph known(laps);
  known.graph.keyframes[kChanged].view = known.graph.keyframes[kChanged - 20].view;
  const RevisitTracker::Followed result = followed(laps, known);
  EXPECT_FALSE(result.redundant[kChanged]);
  EXPECT_EQ(result.num_followed, end_of_followed(laps));
  EXPECT_GE(num_known(result) + 2, num_known(followed(laps, KnownGraph(laps))));
}

TEST(RevisitTracker, KnowNothingAgainInAnotherSession) {
  const Laps& laps = two_laps();
  constexpr std::size_t kStart = kSettled + 4;
  KnownGraph known(laps);
  known.graph.edges[kStart - 1] = {};
  known.graph.edges[kStart - 2].transition_scores =
      no_transition_scores(known.graph.edges[kStart - 2], known.graph.edges[kStart - 1]);
  known.graph.edges[kStart - 1].transition_scores =
      no_transition_scores(known.graph.edges[kStart - 1], known.graph.edges[kStart]);
  choose_candidates(known.graph);
  const RevisitTracker::Followed result = followed(laps, known);
  EXPECT_EQ(result.map.edge_choice[kStart - 1], kCut);
  EXPECT_EQ(num_known(result, kStart), 0U);
  EXPECT_EQ(num_known(followed(laps, known, {loop_to(laps, kStart + 9)}), kStart), 0U);
  for (std::size_t b = kStart; b < end_of_followed(laps); ++b) EXPECT_NE(result.map.component[b], 0U) << b;
}

/// Keyframes come in small portions and are culled in between, as in a mapper.
TEST(RevisitTracker, GoOnWhereTheyWere) {
  const Laps& laps = two_laps();
  KnownGraph all(laps);
  KnownGraph known(laps);
  known.graph.keyframes.resize(kSettled + kLocalization.redundancy.keyframes_in_use);
  known.graph.edges.resize(kSettled + kLocalization.redundancy.keyframes_in_use - 1);
  choose_candidates(known.graph);
  OptimizedMap map = known.map;
  map.map_from_keyframe.resize(known.graph.keyframes.size());
  map.component.resize(known.graph.keyframes.size());
  map.edge_choice.resize(known.graph.edges.size());
  map.loop_constrained.resize(known.graph.edges.size());
  const MappingOptions options = quick();
  RevisitTracker revisits(options.robust);
  revisits.start(known.graph, map, kSettled);
  LoopCandidates loops;
  std::size_t num_culled = 0;
  for (std::size_t next = kSettled + kLocalization.redundancy.keyframes_in_use; next < laps.truth.size(); next += 7) {
    for (std::size_t i = next; i < std::min(next + 7, laps.truth.size()); ++i) {
      known.graph.keyframes.push_back(all.graph.keyframes[i]);
      known.graph.edges.push_back(all.graph.edges[i - 1]);
    }
    choose_candidates(known.graph);
    RevisitTracker::Followed result = revisits.follow(known.graph, {});
    num_culled += num_known(result);
    const std::size_t num_open = known.graph.keyframes.size() - result.num_followed;
    cull_keyframes(result.redundant, quick(), result.map, known.graph, loops);
    ASSERT_EQ(result.map.map_from_keyframe.size(), known.graph.keyframes.size());
    for (std::size_t i = 0; i < known.graph.keyframes.size(); ++i) {
      const Pose2& truth = laps.truth[known.graph.keyframes[i].scan_index];
      EXPECT_THAT(result.map.map_from_keyframe[i], test::IsNearPose(truth, 0.10, 2 * kDegree));
    }
    for (const PoseConstraint& constraint : result.map.constraints) {
      const Pose2& a = laps.truth[known.graph.keyframes[constraint.a].scan_index];
      const Pose2& b = laps.truth[known.graph.keyframes[constraint.b].scan_index];
      EXPECT_THAT(constraint.a_from_b, test::IsNearPose(inverse(a) * b, 0.10, 2 * kDegree));
    }
    revisits.renew(std::move(result.map), num_open);
  }
  EXPECT_EQ(num_culled, num_known(followed(laps, all)));
  EXPECT_EQ(known.graph.keyframes.size(), laps.truth.size() - num_culled);
}

}  // namespace
}  // namespace shapemap
