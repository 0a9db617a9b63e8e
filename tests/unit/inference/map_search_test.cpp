// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/inference/map_search.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <thread>

#include "shapemap/inference/map_score.hpp"
#include "support/matchers.hpp"
#include "support/patience.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::kRingLap;
using test::Patience;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::size_t kAgain = 8;  // The number of steps that are walked a second time.
constexpr double kGood_m = 0.35;

/// A walk of a little more than one lap, with odometry that drifts to the left all the time.
struct Ring {
  explicit Ring(double drift_rad = 0.5 * kDegree) : edges(test::drifting_edges(truth, drift_rad)) {}

  LoopCluster again(double strength) const { return test::cluster_of(truth, {0, kRingLap, kAgain}, strength); }

  /// Returns a wrong loop, which lays the far side of the ring on the near one.
  LoopCluster wrong(double strength) const {
    const Pose2 far_to_near = truth[3] * inverse(truth[28]);
    return test::cluster_of(truth, {3, 28, 5}, strength, far_to_near);
  }

  MapSolution closed(const std::vector<LoopCluster>& clusters, RunObserver& observer, int threads = 1) const {
    return search_map({views, edges, {}, clusters}, {}, {}, {threads, observer});
  }
  MapSolution closed(const std::vector<LoopCluster>& clusters, int threads = 1) const {
    RunObserver nobody;
    return closed(clusters, nobody, threads);
  }

  std::vector<Pose2> truth = test::ring_walk(kRingLap + kAgain, 2);
  test::Views views = test::views_along(test::ring_world(1), truth);
  std::vector<Edge> edges;
};

void expect_same_bits(const MapSolution& a, const MapSolution& b) {
  ASSERT_EQ(a.map_from_node.size(), b.map_from_node.size());
  for (std::size_t n = 0; n < a.map_from_node.size(); ++n) {
    EXPECT_THAT(a.map_from_node[n], HasSameBits(b.map_from_node[n])) << n;
  }
  EXPECT_EQ(a.edge_choice, b.edge_choice);
  EXPECT_EQ(a.accepted, b.accepted);
  EXPECT_EQ(a.component, b.component);
  EXPECT_EQ(a.value, b.value);
}

TEST(SearchMap, WithoutLoopsLeavesTheOdometryAsItIs) {
  const Ring ring;
  const MapSolution solution = ring.closed({});
  EXPECT_THAT(solution.accepted, IsEmpty());
  EXPECT_THAT(solution.edge_choice, Each(0));
  EXPECT_THAT(solution.component, Each(0));
  const std::vector<Pose2> chain = test::dead_reckoning(ring.edges);
  for (std::size_t n = 0; n < chain.size(); ++n) {
    EXPECT_THAT(solution.map_from_node[n], test::IsNearPose(chain[n], 1e-9, 1e-9));
  }
}

TEST(SearchMap, ClosesARingThatHasDriftedApart) {
  const Ring ring;
  ASSERT_GT(test::worst_off_m(test::dead_reckoning(ring.edges), ring.truth), 1.5);
  const MapSolution solution = ring.closed({ring.again(12.0)});
  EXPECT_THAT(solution.accepted, ElementsAre(0));
  EXPECT_THAT(solution.edge_choice, Each(0));
  EXPECT_THAT(solution.component, Each(0));
  EXPECT_LT(test::worst_off_m(solution.map_from_node, ring.truth), kGood_m);
  EXPECT_GT(solution.value, ring.closed({}).value);
}

TEST(SearchMap, RefusesALoopThatIsWrongHoweverStrong) {
  const Ring ring;
  const MapSolution alone = ring.closed({ring.wrong(18.0)});
  EXPECT_THAT(alone.accepted, IsEmpty());
  EXPECT_EQ(alone.value, ring.closed({}).value);
  const MapSolution both = ring.closed({ring.wrong(18.0), ring.again(12.0)});
  EXPECT_THAT(both.accepted, ElementsAre(1));
  EXPECT_LT(test::worst_off_m(both.map_from_node, ring.truth), kGood_m);
}

/// The constraints of the graph allow the loop, but the scans contradict it.
TEST(SearchMap, RefusesALoopThatPullsScansThatAgreeApart) {
  Ring ring(0.0);
  for (Edge& edge : ring.edges) edge.candidates[0].covariance = test::covariance_of(0.3, 10 * kDegree);
  const auto shifted_by = [&](double shift_m) {
    return test::cluster_of(ring.truth, {0, kRingLap, kAgain}, 12.0, {shift_m, 0.0, 0.0});
  };
  EXPECT_THAT(ring.closed({shifted_by(1.2)}).accepted, IsEmpty());
  EXPECT_THAT(ring.closed({shifted_by(0.0)}).accepted, ElementsAre(0));
}

TEST(SearchMap, LeavesAloneWhatIsTooWeak) {
  const Ring ring;
  EXPECT_THAT(ring.closed({ring.again(1.0)}).accepted, IsEmpty());
}

TEST(SearchMap, TakesTheOtherCandidateOfAnEdgeThatLoopsContradict) {
  Ring ring(0.1 * kDegree);
  constexpr std::size_t kBad = 20;
  Edge& bad = ring.edges[kBad];
  const Pose2 right = bad.candidates[0].a_from_b;
  bad.candidates = {
      {kBad, kBad + 1, right * Pose2{0.3, -0.5, 70 * kDegree}, test::covariance_of(0.03, 1 * kDegree), 1.0},
      {kBad, kBad + 1, right, test::covariance_of(0.03, 1 * kDegree), 0.0}};
  bad.probability = 0.4;
  const MapSolution solution = ring.closed({ring.again(12.0)});
  EXPECT_THAT(solution.accepted, ElementsAre(0));
  for (std::size_t i = 0; i < ring.edges.size(); ++i) EXPECT_EQ(solution.edge_choice[i], i == kBad ? 1 : 0) << i;
  EXPECT_LT(test::worst_off_m(solution.map_from_node, ring.truth), kGood_m);
}

TEST(SearchMap, CutsAnEdgeThatIsWrongWithoutAnotherCandidate) {
  Ring ring(0.05 * kDegree);
  constexpr std::size_t kBad = 20;
  Edge& bad = ring.edges[kBad];
  bad.candidates[0].a_from_b = bad.candidates[0].a_from_b * Pose2{0.3, -0.5, 70 * kDegree};
  bad.probability = 0.3;
  const MapSolution solution = ring.closed({ring.again(16.0)});
  EXPECT_THAT(solution.accepted, ElementsAre(0));
  for (std::size_t i = 0; i < ring.edges.size(); ++i) EXPECT_EQ(solution.edge_choice[i], i == kBad ? kCut : 0) << i;
  EXPECT_THAT(solution.component, Each(0)) << "the loop holds what comes after it";
  EXPECT_LT(test::worst_off_m(solution.map_from_node, ring.truth), 2 * kGood_m);
}

/// Turns the first candidates of both edges of a node, so that it faces the other way. The right candidate of only one
/// of the two edges makes the map worse.
void turn_node(Ring& ring, std::size_t node) {
  const Pose2 turned{0.0, 0.0, kPi};
  for (const std::size_t i : {node - 1, node}) {
    Edge& edge = ring.edges[i];
    const Pose2 right = edge.candidates[0].a_from_b;
    edge.candidates.push_back(edge.candidates[0]);
    edge.candidates[0].a_from_b = i < node ? right * turned : turned * right;
    edge.candidates[0].score = 1.0;
    edge.probability = 0.5;
  }
}

TEST(SearchMap, TakesTwoCandidatesThatOnlyTogetherAreBetter) {
  Ring ring(0.1 * kDegree);
  turn_node(ring, 20);
  const MapSolution solution = ring.closed({ring.again(12.0)});
  for (std::size_t i = 0; i < ring.edges.size(); ++i) {
    EXPECT_EQ(solution.edge_choice[i], i == 19 || i == 20 ? 1 : 0) << i;
  }
  EXPECT_THAT(solution.accepted, ElementsAre(0));
  EXPECT_LT(test::worst_off_m(solution.map_from_node, ring.truth), kGood_m);
}

/// Several edges are wrong. Those without another candidate can be replaced by loop candidates that are in no cluster.
TEST(SearchMap, IsAtLeastAsGoodWithLoopCandidatesAsWithout) {
  RunObserver nobody;
  double gained = 0.0;
  for (std::size_t bad = 8; bad <= 40; bad += 8) {
    Ring ring(0.1 * kDegree);
    turn_node(ring, bad + 4);
    EdgeCandidate& wrong = ring.edges[bad].candidates[0];
    wrong.a_from_b = wrong.a_from_b * Pose2{0.3, -0.5, 70 * kDegree};
    ring.edges[bad].probability = 0.3;
    const std::vector<LoopCluster> clusters{test::cluster_of(ring.truth, {bad - 1, bad + 1, 2}, 8.0)};
    const auto closed = [&](const std::vector<EdgeCandidate>& candidates) {
      return search_map({ring.views, ring.edges, candidates, clusters}, {}, {}, {1, nobody});
    };
    const MapSolution with = closed(clusters[0].members);
    const MapSolution without = closed({});
    EXPECT_GE(with.value, without.value) << bad;
    EXPECT_LT(test::worst_off_m(with.map_from_node, ring.truth), 1.0) << bad;
    gained += with.value - without.value;
  }
  EXPECT_GT(gained, 10.0);
}

/// Two walks, in the same world or in two worlds. Nothing is known of where the second one starts.
struct TwoWalks {
  explicit TwoWalks(bool same_world) {
    const std::vector<Pose2> second = test::ring_walk(12, 6, 2.0);
    const test::Views more = test::views_along(test::ring_world(same_world ? 1 : 7), second, 50);
    truth.insert(truth.end(), second.begin(), second.end());
    views.insert(views.end(), more.begin(), more.end());
    edges = test::drifting_edges(truth, 0.2 * kDegree);
    edges[kFirst - 1] = {};
  }

  MapSolution closed(const std::vector<LoopCluster>& clusters) const {
    RunObserver nobody;
    return search_map({views, edges, {}, clusters}, {}, {}, {1, nobody});
  }

  static constexpr std::size_t kFirst = 16;
  std::vector<Pose2> truth = test::ring_walk(kFirst, 5);
  test::Views views = test::views_along(test::ring_world(1), truth);
  std::vector<Edge> edges;
};

TEST(SearchMap, JoinsTwoSessionsOfOneWorld) {
  const TwoWalks walks(true);
  const MapSolution solution = walks.closed({test::cluster_of(walks.truth, {3, TwoWalks::kFirst, 8}, 24.0)});
  EXPECT_THAT(solution.accepted, ElementsAre(0));
  EXPECT_THAT(solution.component, Each(0));
  EXPECT_EQ(solution.edge_choice[TwoWalks::kFirst - 1], kCut) << "the log has nothing to say there";
  EXPECT_LT(test::worst_off_m(solution.map_from_node, walks.truth), kGood_m);
}

TEST(SearchMap, KeepsTwoWorldsApart) {
  const TwoWalks walks(false);
  const LoopCluster wrong = test::cluster_of(walks.truth, {3, TwoWalks::kFirst, 8}, 8.0);
  for (const MapSolution& solution : {walks.closed({}), walks.closed({wrong})}) {
    EXPECT_THAT(solution.accepted, IsEmpty());
    for (std::size_t n = 0; n < walks.truth.size(); ++n) {
      EXPECT_EQ(solution.component[n], n < TwoWalks::kFirst ? 0U : TwoWalks::kFirst);
    }
    const auto pair = near_pairs(solution.map_from_node, 100.0);
    for (const auto& [a, b] : pair) EXPECT_EQ(solution.component[a], solution.component[b]) << "far from each other";
    EXPECT_LT(test::worst_off_m(solution.map_from_node, walks.truth, TwoWalks::kFirst, walks.truth.size()), 1.0);
  }
}

TEST(SearchMap, DoesNotJoinSessionsByAWeakLoop) {
  const TwoWalks walks(true);
  const LoopCluster weak = test::cluster_of(walks.truth, {3, TwoWalks::kFirst, 8}, 12.0);
  EXPECT_THAT(walks.closed({weak}).accepted, IsEmpty());
}

TEST(SearchMap, DoesNotJoinSessionsThatTwoLoopsWouldJoinDifferently) {
  const TwoWalks walks(true);
  LoopCluster right = test::cluster_of(walks.truth, {3, TwoWalks::kFirst, 8}, 24.0);
  LoopCluster rival = right;
  for (EdgeCandidate& member : rival.members) member.a_from_b = member.a_from_b * Pose2{0.0, 0.0, kPi};
  rival.strength = 11.0;
  EXPECT_THAT(walks.closed({right, rival}).accepted, ElementsAre(0)) << "less than half as strong";
  rival.strength = 20.0;
  EXPECT_THAT(walks.closed({right, rival}).accepted, IsEmpty());
}

TEST(SearchMap, StoppedAtAnyTimeHasAWholeSolution) {
  Ring ring;
  ring.edges[20].probability = 0.4;
  ring.edges[20].candidates.push_back(ring.edges[20].candidates[0]);
  ring.edges[20].candidates[0].a_from_b.theta_rad += 0.8;
  const std::vector<LoopCluster> clusters{ring.wrong(14.0), ring.again(12.0)};
  Patience patient(100000);
  const MapSolution whole = ring.closed(clusters, patient);
  ASSERT_LT(patient.asked, 1000U);
  double value = -std::numeric_limits<double>::infinity();
  for (std::size_t times = 0; times <= patient.asked + 1; times += times < 8 ? 1 : 3) {
    Patience observer(times);
    const MapSolution solution = ring.closed(clusters, observer);
    ASSERT_EQ(solution.map_from_node.size(), ring.truth.size());
    ASSERT_EQ(solution.edge_choice.size(), ring.edges.size());
    ASSERT_EQ(solution.component.size(), ring.truth.size());
    for (const Pose2& pose : solution.map_from_node) ASSERT_TRUE(std::isfinite(pose.x_m + pose.y_m + pose.theta_rad));
    for (const std::size_t k : solution.accepted) ASSERT_LT(k, clusters.size());
    EXPECT_GE(solution.value, value) << "the longer, the better";
    value = solution.value;
  }
  Patience just_enough(patient.asked + 1);
  expect_same_bits(ring.closed(clusters, just_enough), whole);
}

TEST(SearchMap, IsTheSameToTheBitForAnyNumberOfThreads) {
  const Ring ring;
  const std::vector<LoopCluster> clusters{ring.wrong(14.0), ring.again(12.0)};
  expect_same_bits(ring.closed(clusters, 3), ring.closed(clusters, 1));
}

struct AskedByOne : RunObserver {
  bool keep_going() override {
    ++asked;
    is_same = is_same && std::this_thread::get_id() == owner;
    return true;
  }
  std::thread::id owner = std::this_thread::get_id();
  std::size_t asked = 0;
  bool is_same = true;
};

TEST(SearchMap, AsksTheObserverFromOneThread) {
  const Ring ring;
  AskedByOne observer;
  ring.closed({ring.wrong(14.0), ring.again(12.0)}, observer, 3);
  EXPECT_GT(observer.asked, 0U);
  EXPECT_TRUE(observer.is_same);
}

TEST(SearchMap, OfOneNodeIsThatNode) {
  RunObserver nobody;
  const test::Views views = test::views_along(test::ring_world(1), test::ring_walk(1, 1));
  const MapSolution solution = search_map({views, {}, {}, {}}, {}, {}, {1, nobody});
  ASSERT_EQ(solution.map_from_node.size(), 1U);
  EXPECT_THAT(solution.map_from_node[0], HasSameBits(Pose2{}));
  EXPECT_THAT(solution.component, ElementsAre(0));
}

}  // namespace
}  // namespace shapemap
