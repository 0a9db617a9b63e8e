// SPDX-License-Identifier: GPL-3.0-or-later
#include "inference/doubtful_edges.hpp"

#include <gmock/gmock.h>

#include "shapemap/inference/map_search.hpp"
#include "support/matchers.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using ::testing::Each;
using ::testing::IsEmpty;
using ::testing::Ne;
using ::testing::SizeIs;

constexpr std::size_t kEdge = 6;
const Pose2 kTurnedAway{0.8, -0.6, kPi / 2};

/// A walk round a corner of the ring. Edge 6 is cut for a wrong loop, which moves all nodes after it.
struct CutForALoop {
  explicit CutForALoop(double strength, const test::Scanner& scanner = test::full_circle())
      : views(test::views_along(test::ring_world(1), truth, 1, scanner)) {
    for (std::size_t n = 0; n < truth.size(); ++n) graph.keyframes.push_back({n, 0, views[n], {}, {}});
    for (std::size_t i = 0; i + 1 < truth.size(); ++i) {
      OdometryEdge& edge = graph.edges.emplace_back();
      edge.candidates = {candidate_at(*views[i], *views[i + 1], step(i), {})};
      edge.choice = {0, kFullMargin, {0.0}};
    }
    map.map_from_keyframe = truth;
    const Pose2 move = truth[kEdge] * step(kEdge) * kTurnedAway * inverse(truth[kEdge + 1]);
    for (std::size_t n = kEdge + 1; n < truth.size(); ++n) map.map_from_keyframe[n] = move * truth[n];
    map.edge_choice.assign(graph.edges.size(), 0);
    map.edge_choice[kEdge] = kCut;
    map.loop_constrained.assign(graph.edges.size(), false);
    map.loop_constrained[kEdge] = true;
    map.component.assign(truth.size(), 0);
    const std::vector<Pose2>& wrong = map.map_from_keyframe;
    map.loops = {{kEdge - 1, kEdge + 2, inverse(wrong[kEdge - 1]) * wrong[kEdge + 2], strength}};
  }

  Pose2 step(std::size_t i) const { return inverse(truth[i]) * truth[i + 1]; }

  bool verify(MatchCache* store = nullptr) {
    RobustOptions options;
    RunObserver nobody;
    return verify_doubtful_edges(options, {1, nobody}, store, graph, map);
  }

  std::vector<Pose2> truth = test::ring_walk(14, 2, 4.0);
  test::Views views;
  KeyframeGraph graph;
  OptimizedMap map;
};

TEST(DoubtfulEdges, AWeakLoopForWhichAnEdgeWasCutIsVerified) {
  CutForALoop walk(5.0);
  ASSERT_TRUE(walk.verify());
  EXPECT_THAT(walk.map.loops, IsEmpty()) << "the scans of both sides speak against it";
  EXPECT_THAT(walk.map.edge_choice, Each(Ne(kCut)));
  EXPECT_THAT(walk.map.component, Each(0U));
  EXPECT_THAT(walk.map.loop_constrained, Each(false));
  EXPECT_LT(test::worst_off_m(walk.map.map_from_keyframe, walk.truth), 0.1);
}

TEST(DoubtfulEdges, AStrongLoopIsNot) {
  CutForALoop walk(25.0);
  walk.verify();
  EXPECT_THAT(walk.map.loops, SizeIs(1));
  EXPECT_EQ(walk.map.edge_choice[kEdge], kCut);
}

TEST(DoubtfulEdges, NoneAreLookedForWhereNoneAreWanted) {
  CutForALoop walk(5.0);
  const std::vector<Pose2> before = walk.map.map_from_keyframe;
  RobustOptions options;
  options.edge_verification.doubt_below = 0.0;
  RunObserver nobody;
  EXPECT_FALSE(verify_doubtful_edges(options, {1, nobody}, nullptr, walk.graph, walk.map));
  for (std::size_t n = 0; n < before.size(); ++n) EXPECT_THAT(walk.map.map_from_keyframe[n], HasSameBits(before[n]));
}

TEST(DoubtfulEdges, TheEvidenceOfAllScansIsTheProbabilityOfTheEdge) {
  CutForALoop walk(5.0);
  EXPECT_FALSE(walk.graph.edges[kEdge].verified);
  walk.verify();
  ASSERT_TRUE(walk.graph.edges[kEdge].verified);
  EXPECT_EQ(walk.graph.edges[kEdge].verified->candidate, static_cast<std::size_t>(walk.map.edge_choice[kEdge]));
  EXPECT_GE(walk.graph.edges[kEdge].verified->probability, RobustOptions().front_end.split_below);
  EXPECT_DOUBLE_EQ(stated_probability(walk.graph.edges[kEdge]), walk.graph.edges[kEdge].verified->probability);
  EXPECT_FALSE(walk.graph.edges[kEdge - 1].verified) << "nobody was asked";
}

TEST(DoubtfulEdges, ScansThatSeeLittleLeaveMoreDoubt) {
  const auto doubt = [](double insufficient_view) {
    CutForALoop walk(5.0);
    walk.graph.edges[kEdge].insufficient_view = insufficient_view;
    walk.verify();
    return 1.0 - walk.graph.edges[kEdge].verified.value().probability;
  };
  EXPECT_GT(doubt(0.2), 5.0 * doubt(0.0));
}

TEST(DoubtfulEdges, NoVerdictIsStatedWhereTheObserverAskedToStop) {
  struct Impatient : RunObserver {
    bool keep_going() override { return false; }
  } impatient;
  CutForALoop walk(5.0);
  RobustOptions options;
  verify_doubtful_edges(options, {1, impatient}, nullptr, walk.graph, walk.map);
  for (const OdometryEdge& edge : walk.graph.edges) EXPECT_FALSE(edge.verified);
}

/// No edge reaches the probability that is asked for.
TEST(DoubtfulEdges, WhatStaysInDoubtSplitsTheMapAndOpensTheLoop) {
  CutForALoop walk(5.0);
  RobustOptions options;
  options.front_end.split_below = 1.0;
  RunObserver nobody;
  ASSERT_TRUE(verify_doubtful_edges(options, {1, nobody}, nullptr, walk.graph, walk.map));
  EXPECT_THAT(walk.map.loops, IsEmpty());
  EXPECT_EQ(walk.map.edge_choice[kEdge], kCut);
  EXPECT_NE(walk.map.component[kEdge], walk.map.component[kEdge + 1]);
  EXPECT_FALSE(walk.map.loop_constrained[kEdge]);
  ASSERT_TRUE(walk.graph.edges[kEdge].verified) << "the best is reported all the same";
  EXPECT_GT(walk.graph.edges[kEdge].verified->probability, 0.5);
}

TEST(DoubtfulEdges, WhatIsNotClearIsSearchedAgain) {
  const auto candidates_of = [](double clear_above) {
    CutForALoop walk(5.0);
    RobustOptions options;
    options.edge_verification.clear_above = clear_above;
    RunObserver nobody;
    verify_doubtful_edges(options, {1, nobody}, nullptr, walk.graph, walk.map);
    return walk.graph.edges[kEdge].candidates.size();
  };
  EXPECT_GT(candidates_of(1.0), candidates_of(0.0));
}

/// The new candidates get the same motion prior as the old ones. Otherwise the many distant places that a thorough
/// search finds would outweigh the true one together.
TEST(DoubtfulEdges, WhatIsSearchedAgainScoresLessFarFromWhereTheScanWasToBeExpected) {
  CutForALoop walk(5.0);
  const ExpectedPose expected{walk.step(kEdge)};
  walk.graph.keyframes[kEdge + 1].expected = expected;
  RobustOptions options;
  options.edge_verification.clear_above = 1.0;
  RunObserver nobody;
  verify_doubtful_edges(options, {1, nobody}, nullptr, walk.graph, walk.map);
  double most = 0.0;
  for (const MatchCandidate& pose : walk.graph.edges[kEdge].candidates) {
    const double unlikely = surprise(expected, pose.ref_from_query);
    const double by_scans = candidate_at(*walk.views[kEdge], *walk.views[kEdge + 1], pose.ref_from_query, {}).score;
    EXPECT_NEAR(pose.score, by_scans - unlikely, 0.05);
    most = std::max(most, unlikely);
  }
  EXPECT_GT(most, 4.0);
}

/// This must hold for scans with half a field of view as well.
TEST(DoubtfulEdges, AnEdgeThatTheOthersContradictIsReplaced) {
  CutForALoop walk(5.0, test::half_circle());
  walk.map.loops.clear();
  walk.map.loop_constrained[kEdge] = false;
  OdometryEdge& edge = walk.graph.edges[kEdge];
  edge.candidates.insert(edge.candidates.begin(), edge.candidates[0]);
  edge.candidates[0].ref_from_query = walk.step(kEdge) * kTurnedAway;
  edge.choice = {0, 0.1, {0.0, 0.0}};
  walk.map.edge_choice[kEdge] = 0;
  ASSERT_TRUE(walk.verify());
  EXPECT_EQ(walk.map.edge_choice[kEdge], 1);
  EXPECT_LT(test::worst_off_m(walk.map.map_from_keyframe, walk.truth), 0.1);
}

}  // namespace
}  // namespace shapemap
