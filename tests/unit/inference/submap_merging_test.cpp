// SPDX-License-Identifier: GPL-3.0-or-later
#include "inference/submap_merging.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <set>

#include "support/matchers.hpp"
#include "support/patience.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::IsNearPose;
using test::kRingLap;

const Pose2 kTurned{0.0, 0.0, kPi};

/// A walk of a little more than one lap, whose edges a test can make doubtful.
struct Walk {
  explicit Walk(double drift_rad = 0.1 * kDegree, unsigned seed = 2)
      : truth(test::ring_walk(kRingLap + 8, seed)), edges(test::drifting_edges(truth, drift_rad)), right(edges) {}

  /// Puts a wrong candidate first. The right one comes second, or is removed.
  void spoil(std::size_t edge, const Pose2& wrong, bool keep_right = true) {
    std::vector<EdgeCandidate>& candidates = edges[edge].candidates;
    EdgeCandidate first = candidates.front();
    first.a_from_b = wrong;
    first.score = 1.0;
    if (!keep_right) candidates.clear();
    candidates.insert(candidates.begin(), first);
    edges[edge].probability = 0.5;
  }

  /// Turns a node as if the robot had turned round for one scan.
  void turn_node(std::size_t node) {
    spoil(node - 1, edges[node - 1].candidates[0].a_from_b * kTurned);
    spoil(node, inverse(kTurned) * edges[node].candidates[0].a_from_b);
  }

  std::vector<Pose2> assembled(const std::vector<EdgeCandidate>& candidates, RunObserver& observer, int variant = 0,
                               int threads = 1) const {
    MapScore score(views, {}, threads);
    return merged_submaps({edges, candidates, chain()}, score, {}, variant, observer);
  }
  std::vector<Pose2> assembled(const std::vector<EdgeCandidate>& candidates = {}, int variant = 0,
                               int threads = 1) const {
    RunObserver nobody;
    return assembled(candidates, nobody, variant, threads);
  }

  /// Returns the poses by first candidates; other sessions are far away.
  std::vector<Pose2> chain() const {
    std::vector<Pose2> poses{{}};
    for (const Edge& edge : edges) {
      const Pose2 step = edge.exists() ? edge.candidates[0].a_from_b : Pose2{1e4, 0.0, 0.0};
      poses.push_back(poses.back() * step);
    }
    return poses;
  }
  double worth(const std::vector<Pose2>& poses) const { return MapScore(views, {}, 1).of(poses); }

  std::vector<Pose2> truth;
  test::Views views = test::views_along(test::ring_world(1), truth);
  std::vector<Edge> edges;
  std::vector<Edge> right;
};

/// Compares relative poses, since the frame of a map does not matter.
void expect_same_map(const std::vector<Pose2>& one, const std::vector<Pose2>& other, double off = 1e-6) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t n = 0; n < one.size(); ++n) {
    EXPECT_THAT(inverse(one[0]) * one[n], IsNearPose(inverse(other[0]) * other[n], off, off)) << n;
  }
}

TEST(MergedSubmaps, OfSureEdgesAreTheOdometry) {
  const Walk walk;
  expect_same_map(walk.assembled(), walk.chain(), 0.0);
}

TEST(MergedSubmaps, TurnANodeThatBothItsEdgesHaveWrong) {
  Walk walk;
  walk.turn_node(20);
  Walk only_before = walk;
  only_before.edges[19] = walk.right[19];
  Walk only_after = walk;
  only_after.edges[20] = walk.right[20];
  ASSERT_LT(walk.worth(only_before.chain()), walk.worth(walk.chain())) << "one alternative alone makes it worse";
  ASSERT_LT(walk.worth(only_after.chain()), walk.worth(walk.chain()));
  expect_same_map(walk.assembled(), test::dead_reckoning(walk.right));
}

/// Tries all combinations of candidates of the edges `doubtful`, and returns the map with the largest value.
std::vector<Pose2> best_of_all_choices(const Walk& walk, const std::vector<std::size_t>& doubtful) {
  std::vector<Pose2> best;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t choice = 0; choice < std::size_t{1} << doubtful.size(); ++choice) {
    Walk chosen = walk;
    for (std::size_t k = 0; k < doubtful.size(); ++k) {
      std::vector<EdgeCandidate>& candidates = chosen.edges[doubtful[k]].candidates;
      if ((choice >> k & 1U) != 0) std::swap(candidates[0], candidates[1]);
    }
    const double worth = walk.worth(chosen.chain());
    if (worth > most) best = chosen.chain();
    most = std::max(most, worth);
  }
  return best;
}

TEST(MergedSubmaps, AreTheBestOfAllCombinations) {
  std::mt19937 rng(3);
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Walk walk(0.05 * kDegree, seed);
    std::set<std::size_t> doubtful;
    while (doubtful.size() < 4) doubtful.insert(3 + rng() % (walk.edges.size() - 6));
    for (const std::size_t edge : doubtful) {
      const Pose2 wrong = Pose2{0.7, 0.0, 0.0} * test::random_pose(rng, 0.6, 2.0) * Pose2{0.0, 0.0, 40 * kDegree};
      walk.spoil(edge, walk.edges[edge].candidates[0].a_from_b * wrong);
    }
    const std::vector<Pose2> best = best_of_all_choices(walk, {doubtful.begin(), doubtful.end()});
    expect_same_map(best, test::dead_reckoning(walk.right));
    expect_same_map(walk.assembled(), best);
  }
}

TEST(MergedSubmaps, ReplaceAnEdgeThatHasNoRightCandidate) {
  Walk walk;
  walk.spoil(20, walk.edges[20].candidates[0].a_from_b * Pose2{0.3, -0.5, 70 * kDegree}, false);
  const std::vector<EdgeCandidate> bridge = test::cluster_of(walk.truth, {18, 21, 3}, 0.0).members;
  EXPECT_GT(test::worst_off_m(walk.assembled(), walk.truth), 5.0);
  EXPECT_LT(test::worst_off_m(walk.assembled(bridge), test::dead_reckoning(walk.right)), 1.0);
  std::vector<EdgeCandidate> wrong = bridge;
  for (EdgeCandidate& candidate : wrong) candidate.a_from_b = candidate.a_from_b * kTurned;
  wrong.insert(wrong.end(), bridge.begin(), bridge.end());
  EXPECT_LT(test::worst_off_m(walk.assembled(wrong), test::dead_reckoning(walk.right)), 1.0) << "the scans tell";
}

/// The walk comes back to its start. The drift of odometry until then must be spread over all edges, and not only
/// corrected at the one doubtful edge.
TEST(MergedSubmaps, AreBentToTheirLoopCandidates) {
  for (const double drift_deg : {0.1, 0.15}) {
    Walk walk(drift_deg * kDegree);
    walk.edges[30].probability = 0.6;
    const std::vector<EdgeCandidate> again = test::cluster_of(walk.truth, {0, kRingLap, 8}, 0.0).members;
    ASSERT_GT(test::worst_off_m(walk.assembled(), walk.truth), 0.5);
    const std::vector<Pose2> map = walk.assembled(again);
    EXPECT_LT(test::worst_off_m(map, walk.truth), 0.2);
    EXPECT_THAT(inverse(map[30]) * map[31], IsNearPose(walk.edges[30].candidates[0].a_from_b, 0.05, 1 * kDegree));
    EXPECT_GT(walk.worth(map), walk.worth(walk.chain()) + 50.0);
  }
}

TEST(MergedSubmaps, NeverJoinDifferentSessions) {
  Walk walk;
  constexpr std::size_t kLast = 24;
  walk.edges[kLast] = {};
  walk.turn_node(10);
  walk.turn_node(40);
  std::vector<EdgeCandidate> joins = test::cluster_of(walk.truth, {0, kRingLap, 8}, 0.0).members;
  const std::vector<EdgeCandidate> more = test::cluster_of(walk.truth, {kLast - 3, kLast + 1, 4}, 0.0).members;
  joins.insert(joins.end(), more.begin(), more.end());
  const std::vector<Pose2> map = walk.assembled(joins);
  EXPECT_THAT(inverse(map[kLast]) * map[kLast + 1], IsNearPose((Pose2{1e4, 0.0, 0.0}), 1e-6, 1e-9));
  const auto first = static_cast<std::ptrdiff_t>(kLast + 1);
  const std::vector<Pose2> right = test::dead_reckoning(walk.right);
  expect_same_map({map.begin(), map.begin() + first}, {right.begin(), right.begin() + first});
  expect_same_map({map.begin() + first, map.end()}, {right.begin() + first, right.end()});
}

TEST(MergedSubmaps, OfAVariantAreTheSameToTheBitForAnyNumberOfThreads) {
  Walk walk;
  walk.turn_node(20);
  walk.turn_node(40);
  const std::vector<EdgeCandidate> again = test::cluster_of(walk.truth, {0, kRingLap, 8}, 0.0).members;
  for (int variant = 0; variant < 4; ++variant) {
    const std::vector<Pose2> map = walk.assembled(again, variant);
    for (const int threads : {1, 3}) {
      const std::vector<Pose2> same = walk.assembled(again, variant, threads);
      ASSERT_EQ(same.size(), map.size());
      for (std::size_t n = 0; n < map.size(); ++n) EXPECT_THAT(same[n], HasSameBits(map[n])) << variant << " " << n;
    }
  }
}

/// These scans see nothing, so the first variant follows the matches, and the others are random.
TEST(MergedSubmaps, DifferBetweenVariantsAtDoubtfulEdges) {
  Walk walk;
  for (auto& view : walk.views) view = std::make_shared<ScanView>(test::view_of(test::blind_scan()));
  walk.turn_node(20);
  expect_same_map(walk.assembled(), walk.chain());
  int as_the_chain = 0;
  constexpr int kVariants = 24;
  for (int variant = 1; variant <= kVariants; ++variant) {
    const std::vector<Pose2> map = walk.assembled({}, variant);
    as_the_chain += test::worst_off_m(map, walk.chain()) < 1e-6 ? 1 : 0;
  }
  EXPECT_GT(as_the_chain, 0);
  EXPECT_LT(as_the_chain, kVariants - 4);
}

/// At a corner of the ring the first variant decides wrongly. Others do not, and the scans show which are right.
TEST(MergedSubmaps, AreRightInSomeVariantWhereTheFirstIsWrong) {
  Walk walk;
  for (const std::size_t node : {10U, 25U, 40U}) walk.turn_node(node);
  std::vector<Pose2> best = walk.assembled();
  const double first_worth = walk.worth(best);
  double most = first_worth;
  for (int variant = 1; variant < 6; ++variant) {
    const std::vector<Pose2> map = walk.assembled({}, variant);
    if (walk.worth(map) > most) best = map;
    most = std::max(most, walk.worth(map));
  }
  EXPECT_GT(most, first_worth + 20.0);
  expect_same_map(best, test::dead_reckoning(walk.right));
}

TEST(MergedSubmaps, StoppedAtAnyTimeHaveTheRestFromOdometry) {
  Walk walk;
  for (const std::size_t node : {10U, 20U, 40U}) walk.turn_node(node);
  test::Patience patient(1000);
  const std::vector<Pose2> whole = walk.assembled({}, patient);
  expect_same_map(whole, test::dead_reckoning(walk.right));
  EXPECT_EQ(patient.asked, 7U) << "once for each time that two of seven pieces are laid together, and at the end";
  const std::vector<Pose2> chain = walk.chain();
  for (std::size_t times = 0; times <= 7; ++times) {
    test::Patience observer(times);
    const std::vector<Pose2> map = walk.assembled({}, observer);
    ASSERT_EQ(map.size(), walk.truth.size());
    std::size_t changed = 0;
    for (std::size_t i = 0; i < walk.edges.size(); ++i) {
      const Pose2 step = inverse(map[i]) * map[i + 1];
      const Pose2 by_chain = walk.edges[i].candidates[0].a_from_b;
      if (testing::Value(step, IsNearPose(by_chain, 1e-6, 1e-6))) continue;
      EXPECT_THAT(step, IsNearPose(walk.right[i].candidates[0].a_from_b, 1e-6, 1e-6)) << i;
      ++changed;
    }
    EXPECT_EQ(changed, times == 0 ? 0 : std::min<std::size_t>(times - 1, 6)) << "one more each time";
    EXPECT_EQ(observer.asked, std::min<std::size_t>(std::max<std::size_t>(times, 1), 7));
  }
}

TEST(MergedSubmaps, OfOneNodeOrNoneAreThat) {
  RunObserver nobody;
  MapScore score(test::views_along(test::ring_world(1), test::ring_walk(1, 1)), {}, 1);
  EXPECT_TRUE(merged_submaps({{}, {}, {}}, score, {}, 0, nobody).empty());
  const std::vector<Pose2> one = merged_submaps({{}, {}, {{1.0, 2.0, 3.0}}}, score, {}, 1, nobody);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_THAT(one[0], HasSameBits(Pose2{1.0, 2.0, 3.0}));
}

}  // namespace
}  // namespace shapemap
