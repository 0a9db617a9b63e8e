// SPDX-License-Identifier: GPL-3.0-or-later
#include "inference/map_hypothesis.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "support/matchers.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::kRingLap;
using ::testing::Each;
using ::testing::ElementsAre;

/// A walk of a little more than one lap, with a loop where it meets itself and a loop that is wrong.
struct Ring {
  explicit Ring(double drift_rad = 0.0) : edges(test::drifting_edges(truth, drift_rad)) {}

  MapObjective problem() { return {GraphEvidence{views, edges, {}, clusters}, {}, options, 1}; }

  void spoil(std::size_t edge, bool keep_right) {
    std::vector<EdgeCandidate>& candidates = edges[edge].candidates;
    const EdgeCandidate right = candidates[0];
    candidates[0].a_from_b = right.a_from_b * Pose2{0.3, -0.5, 70 * kDegree};
    candidates[0].score = 1.0;
    if (keep_right) candidates.push_back(right);
    edges[edge].probability = 0.4;
  }

  std::vector<Pose2> truth = test::ring_walk(kRingLap + 8, 2);
  test::Views views = test::views_along(test::ring_world(1), truth);
  std::vector<Edge> edges;
  std::vector<LoopCluster> clusters{test::cluster_of(truth, {3, 28, 5}, 18.0, {2.0, 0.0, 0.0}),
                                    test::cluster_of(truth, {0, kRingLap, 8}, 12.0)};
  MapSearchOptions options;
};

TEST(HypothesisOfMap, TakesTheCandidatesAndLoopsThatAgreeWithTheMap) {
  Ring ring;
  ring.spoil(20, true);
  const MapHypothesis choice = ring.problem().of_map(ring.truth);
  for (std::size_t i = 0; i < ring.edges.size(); ++i) EXPECT_EQ(choice.edge_choice[i], i == 20 ? 1 : 0) << i;
  EXPECT_THAT(choice.accepted, ElementsAre(0, 1));
  EXPECT_LT(test::worst_off_m(choice.map_from_node, ring.truth), 0.2);
  EXPECT_GT(choice.value, ring.problem().chain_alone().value + 20.0);
}

TEST(MapHypothesis, RingsAreTheNodesThatLoopsConstrain) {
  Ring ring;
  MapObjective problem = ring.problem();
  const std::vector<std::size_t> of_chain = problem.rings(problem.chain_alone());
  for (std::size_t n = 0; n < of_chain.size(); ++n) EXPECT_EQ(of_chain[n], n) << "each by itself";
  MapHypothesis cut = problem.of_map(ring.truth);
  const std::vector<std::size_t> closed = problem.rings(cut);
  for (std::size_t n = 0; n <= kRingLap; ++n) EXPECT_EQ(closed[n], 0U) << n;
  cut.accepted.assign(cut.accepted.size(), 0);
  EXPECT_EQ(problem.rings(cut), of_chain) << "without a loop, none is held";
}

TEST(HypothesisOfMap, CutsAnEdgeThatDisagreesWhereALoopJoinsTheRest) {
  Ring ring;
  ring.spoil(20, false);
  const MapHypothesis choice = ring.problem().of_map(ring.truth);
  EXPECT_THAT(choice.accepted, ElementsAre(0, 1));
  for (std::size_t i = 0; i < ring.edges.size(); ++i) EXPECT_EQ(choice.edge_choice[i], i == 20 ? kCut : 0) << i;
  EXPECT_LT(test::worst_off_m(choice.map_from_node, ring.truth), 0.2);
}

TEST(HypothesisOfMap, KeepsEdgesThatDisagreeWhereNothingElseJoinsTheNodes) {
  Ring ring;
  ring.clusters.clear();
  ring.spoil(20, false);
  ring.spoil(30, false);
  const MapHypothesis choice = ring.problem().of_map(ring.truth);
  EXPECT_THAT(choice.edge_choice, Each(0));
  const std::vector<Pose2> chain = test::dead_reckoning(ring.edges, ring.truth[0]);
  for (std::size_t n = 0; n < chain.size(); ++n) {
    EXPECT_THAT(choice.map_from_node[n], test::IsNearPose(chain[n], 1e-4, 1e-4)) << n;
  }
}

TEST(HypothesisOfMap, DoesNotJoinAnotherSession) {
  Ring ring;
  ring.edges[20] = {};
  MapObjective problem = ring.problem();
  const MapHypothesis chain = problem.chain_alone();
  const MapHypothesis choice = problem.of_map(chain.map_from_node);
  EXPECT_EQ(choice.edge_choice, chain.edge_choice);
  EXPECT_EQ(choice.edge_choice[20], kCut);
  EXPECT_THAT(choice.accepted, Each(0));
}

/// A conflicting loop makes a loop worth less, unless the map agrees with both.
TEST(WorthOfLoops, IsLessByAConflictingLoopThatTheMapContradicts) {
  Ring ring;
  ring.clusters = {test::cluster_of(ring.truth, {0, kRingLap, 4}, 18.0),
                   test::cluster_of(ring.truth, {20, kRingLap, 4}, 11.0, {4.0, 0.0, 0.0}),
                   test::cluster_of(ring.truth, {4, kRingLap + 4, 4}, 30.0)};
  MapObjective problem = ring.problem();
  const MapHypothesis choice = problem.of_map(ring.truth);
  EXPECT_NEAR(problem.worth_in(choice, 0), 7.0, 1e-9);
  EXPECT_NEAR(problem.worth_in(choice, 2), 20.0, 1e-9) << "shares no node, and at most the cap";
  ring.clusters[1] = test::cluster_of(ring.truth, {1, kRingLap, 4}, 11.0, {});
  MapObjective agreeing = ring.problem();
  EXPECT_NEAR(agreeing.worth_in(agreeing.of_map(ring.truth), 0), 18.0, 1e-9);
}

/// Between two stretches that look alike, any number of loops can be wrong together.
TEST(MapValue, OfLoopsBetweenTheSameStretchesIsAtMostTheCap) {
  Ring ring;
  const auto gain_of_second = [&](std::size_t a, std::size_t b) {
    ring.clusters = {test::cluster_of(ring.truth, {0, kRingLap, 8}, 18.0),
                     test::cluster_of(ring.truth, {a, b, 4}, 12.0)};
    MapObjective problem = ring.problem();
    MapHypothesis both = problem.of_map(ring.truth);
    EXPECT_THAT(both.accepted, ElementsAre(1, 1));
    MapHypothesis one = both;
    one.accepted[1] = 0;
    problem.rate(one);
    problem.rate(both);
    return both.value - one.value;
  };
  const auto worth = [](double sum) { return 20.0 * (1.0 - std::exp(-sum / 20.0)); };
  EXPECT_NEAR(gain_of_second(4, kRingLap + 4), worth(30.0) - worth(18.0), 1e-6);
  EXPECT_NEAR(gain_of_second(20, 30), worth(12.0), 1e-6) << "another place";
  ring.options.trust_cap = 0.0;
  EXPECT_EQ(gain_of_second(4, kRingLap + 4), 0.0) << "loops count for nothing, and nothing is divided by it";
}

/// Cutting an edge with a well-fitting candidate is expensive, even if it is not sure which candidate is right.
TEST(MapValue, OfACutEdgeIsLessTheBetterOneOfItsCandidatesFits) {
  Ring ring;
  ring.spoil(20, false);
  const double poor = ring.problem().of_map(ring.truth).value;
  ring.edges[20].any_probability = 0.999;
  const MapHypothesis well = ring.problem().of_map(ring.truth);
  EXPECT_EQ(well.edge_choice[20], kCut);
  EXPECT_NEAR(poor - well.value, std::log(999.0) + 2.0 - (std::log(0.4 / 0.6) + 2.0), 1e-6);
}

TEST(MapValue, IsLessByUnusualTurns) {
  Ring free;
  free.options.step_penalty = 0.0;
  Ring costly;
  costly.options.step_penalty = 8.0;
  free.edges[20].probability = costly.edges[20].probability = 0.9;
  MapObjective without = free.problem();
  MapObjective with = costly.problem();
  const auto penalty = [&](MapHypothesis choice) {
    MapHypothesis same = choice;
    without.rate(choice);
    with.rate(same);
    return choice.value - same.value;
  };
  MapHypothesis map = without.of_map(free.truth);
  EXPECT_NEAR(penalty(map), 0.0, 1e-9);
  map.map_from_node[21].theta_rad += 180 * kDegree;
  EXPECT_GT(penalty(map), 4.0);
}

/// The hypothesis of the map by odometry alone is that map again.
TEST(HypothesisOfMap, OfTheMapByOdometryIsThatMap) {
  Ring ring(1.0 * kDegree);
  MapObjective problem = ring.problem();
  const MapHypothesis chain = problem.chain_alone();
  const MapHypothesis choice = problem.of_map(chain.map_from_node);
  EXPECT_EQ(choice.edge_choice, chain.edge_choice);
  EXPECT_EQ(choice.accepted, chain.accepted);
  EXPECT_NEAR(choice.value, chain.value, 1e-6);
  for (std::size_t n = 0; n < chain.map_from_node.size(); ++n) {
    EXPECT_THAT(choice.map_from_node[n], test::IsNearPose(chain.map_from_node[n], 1e-9, 1e-9));
  }
}

}  // namespace
}  // namespace shapemap
