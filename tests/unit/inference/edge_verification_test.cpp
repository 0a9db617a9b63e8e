// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/inference/edge_verification.hpp"

#include <gmock/gmock.h>

#include "shapemap/inference/map_search.hpp"
#include "shapemap/matching/match_search.hpp"
#include "support/matchers.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

/// Returns a candidate that is exact by its two scans unless `covariance` is given.
EdgeCandidate scored(const Pose2& a_from_b, double score, const Eigen::Matrix3d& covariance = Eigen::Matrix3d::Zero()) {
  return {0, 0, a_from_b, covariance, score};
}

using test::HasSameBits;
using ::testing::Each;
using ::testing::ElementsAre;

const Pose2 kTurnedAway{0.8, -0.6, kPi / 2};
const Pose2 kTooFar{1.4, 0.3, 0.0};

/// A walk round a corner of the ring, in submaps that are right in themselves but wrong relative to each other.
struct Torn {
  explicit Torn(const std::vector<std::size_t>& tears, const Pose2& wrong = kTurnedAway, std::size_t count = 14)
      : truth(test::ring_walk(count, 2, 4.0)), views(test::views_along(test::ring_world(1), truth)) {
    std::size_t first = 0;
    Pose2 moved;
    for (std::size_t n = 0; n < truth.size(); ++n) {
      if (n > 0 && std::find(tears.begin(), tears.end(), n - 1) != tears.end()) {
        first = n;
        moved = poses[n - 1] * inverse(truth[n - 1]) * (truth[n - 1] * true_step(n - 1) * wrong * inverse(truth[n]));
      }
      submaps.push_back(first);
      poses.push_back(moved * truth[n]);
    }
    for (const std::size_t edge : tears) {
      Edge doubt;
      doubt.a = edge;
      doubt.b = edge + 1;
      doubt.candidates = {scored(inverse(poses[edge]) * poses[edge + 1], 1.0), scored(true_step(edge) * kTooFar, 1.5)};
      doubts.push_back(std::move(doubt));
    }
  }

  Pose2 true_step(std::size_t n) const { return inverse(truth[n]) * truth[n + 1]; }

  VerifiedMap verified(double least_probability = 0.7, int threads = 1) {
    RunObserver nobody;
    return verify_edges(views, {poses, submaps}, doubts, {{}, least_probability}, {threads, nobody});
  }

  std::vector<Pose2> truth;
  test::Views views;
  std::vector<Pose2> poses;
  std::vector<std::size_t> submaps;
  std::vector<Edge> doubts;
};

/// Returns for each edge the candidate that joins the submaps, or kCut.
std::vector<int> choices(const VerifiedMap& verified) {
  std::vector<int> chosen;
  for (const VerifiedEdge& edge : verified.edges)
    chosen.push_back(edge.joins ? static_cast<int>(edge.candidate) : kCut);
  return chosen;
}

/// The right candidate has the lowest score of its own.
TEST(VerifyEdges, TakesTheCandidateOfAllScansAndNotOfTheTwoAlone) {
  Torn map({6});
  map.doubts[0].candidates.push_back(scored(map.true_step(6), 0.0));
  const VerifiedMap verified = map.verified();
  EXPECT_THAT(choices(verified), ElementsAre(2));
  EXPECT_THAT(verified.submap_of_node, Each(verified.submap_of_node.front()));
  EXPECT_LT(test::worst_off_m(verified.map_from_node, map.truth), 1e-6);
}

TEST(VerifyEdges, RepairsSeveralOnlyOneOfWhichIsRight) {
  Torn map({3, 8});
  map.doubts[0].candidates.push_back(scored(map.true_step(3), 0.0));
  map.doubts[1].candidates[0].a_from_b = map.true_step(8);  // The map is right at this edge.
  map.doubts[1].candidates.push_back(scored(map.true_step(8) * kTurnedAway, 1.0));
  const VerifiedMap verified = map.verified();
  EXPECT_THAT(choices(verified), ElementsAre(2, 0));
  EXPECT_LT(test::worst_off_m(verified.map_from_node, map.truth), 1e-6);
}

/// The candidates have the scores that their two scans give.
TEST(VerifyEdges, SplitsWhereNoCandidateIsRight) {
  Torn map({6});
  for (EdgeCandidate& candidate : map.doubts[0].candidates) {
    candidate.score = candidate_at(*map.views[6], *map.views[7], candidate.a_from_b, {}).score;
  }
  const VerifiedMap verified = map.verified();
  EXPECT_THAT(choices(verified), ElementsAre(kCut));
  EXPECT_NE(verified.submap_of_node[6], verified.submap_of_node[7]);
  for (std::size_t n = 0; n < map.poses.size(); ++n) {
    EXPECT_THAT(verified.map_from_node[n], HasSameBits(map.poses[n])) << "pieces stay where they are";
  }
}

TEST(VerifyEdges, JoinsNothingWhenNothingIsProbableEnough) {
  Torn map({6});
  map.doubts[0].candidates.push_back(scored(map.true_step(6), 0.0));
  EXPECT_THAT(choices(map.verified(1.0)), ElementsAre(kCut));
}

/// This must hold however good both are, so the score of the other place goes from far behind to far ahead.
TEST(VerifyEdges, SplitsWhereTwoPlacesFitAlike) {
  Torn map({6});
  const Pose2 away = map.doubts[0].candidates[0].a_from_b;
  std::vector<int> chosen;
  for (double score = 0.0; score < 40.0; score += 0.5) {
    map.doubts[0].candidates = {scored(map.true_step(6), 10.0), scored(away, score)};
    const int choice = choices(map.verified()).front();
    if (chosen.empty() || chosen.back() != choice) chosen.push_back(choice);
  }
  EXPECT_THAT(chosen, ElementsAre(0, kCut, 1));
}

/// A small error along a corridor leaves the map nearly right, a large one or one across it does not.
TEST(VerifyEdges, IsNearlyRightWhereItSlides) {
  Torn map({6});
  const auto probability = [&](const Point2& off_m, const Eigen::Vector3d& deviations) {
    const Eigen::Matrix3d covariance = deviations.cwiseAbs2().asDiagonal();
    const Pose2 one = map.true_step(6) * Pose2{0.5 * off_m.x(), 0.5 * off_m.y(), 0.0};
    const Pose2 other = map.true_step(6) * Pose2{-0.5 * off_m.x(), -0.5 * off_m.y(), 0.0};
    map.doubts[0].candidates = {scored(other, 9.0, covariance), scored(one, 10.0, covariance)};
    return map.verified().edges[0].probability;
  };
  const Eigen::Vector3d held(0.02, 0.02, 0.01);
  const Eigen::Vector3d along_x(0.5, 0.02, 0.01);
  const double doubt = 1.0 - probability({0.5, 0.0}, held);
  EXPECT_LT(1.0 - probability({0.5, 0.0}, along_x), 0.6 * doubt);
  EXPECT_GT(1.0 - probability({1.0, 0.0}, along_x), 0.6 * (1.0 - probability({1.0, 0.0}, held)));
  EXPECT_NEAR(probability({0.0, 0.5}, along_x), probability({0.0, 0.5}, held), 1e-9);
}

/// Two candidates that are nearly the same leave no doubt about the pose of the submap.
TEST(VerifyEdges, DoesNotCountTheSamePlaceAsAnother) {
  Torn map({6});
  map.doubts[0].candidates.push_back(scored(map.true_step(6), 0.0));
  map.doubts[0].candidates.push_back(scored(map.true_step(6) * Pose2{0.05, 0.0, 0.5 * kDegree}, 0.0));
  const VerifiedMap verified = map.verified();
  ASSERT_GE(choices(verified).front(), 2);
  EXPECT_GT(verified.edges[0].probability, 0.9);
  EXPECT_LT(test::worst_off_m(verified.map_from_node, map.truth), 0.15);
}

/// The pose of the map is better, since it is matched to more than the two scans.
TEST(VerifyEdges, LeavesTheSubmapWhereTheMapHasItWhenThatIsTheSamePlace) {
  Torn map({6}, Pose2{0.05, 0.0, 0.5 * kDegree});
  map.doubts[0].candidates = {scored(map.doubts[0].candidates[0].a_from_b, 0.0), scored(map.true_step(6), 5.0)};
  const VerifiedMap verified = map.verified();
  EXPECT_THAT(choices(verified), ElementsAre(0));
  EXPECT_LT(test::worst_off_m(verified.map_from_node, map.poses), 1e-6);
}

TEST(VerifyEdges, IsLessSureWithAnotherPlaceAndWhereAllAreBad) {
  Torn map({6});
  map.doubts[0].candidates.push_back(scored(map.true_step(6), 10.0));
  const double alone = map.verified().edges[0].probability;
  EXPECT_GT(alone, 0.99);
  map.doubts[0].candidates.push_back(scored(map.true_step(6) * Pose2{0.0, 0.0, kPi}, 12.0));
  EXPECT_LT(map.verified().edges[0].probability, alone - 0.005);
  for (EdgeCandidate& candidate : map.doubts[0].candidates) candidate.score = -40.0;
  EXPECT_LT(map.verified().edges[0].probability, 0.8) << "it may be none of them";
}

TEST(VerifyEdges, IsLessSureOfScansThatSeeLittle) {
  Torn map({6});
  map.doubts[0].candidates.push_back(scored(map.true_step(6), 0.0));
  const double sure = map.verified().edges[0].probability;
  map.doubts[0].insufficient_view = 0.3;
  EXPECT_LT(map.verified().edges[0].probability, sure - 0.05);
}

/// Nodes 4 to `last` are a submap of their own; the nodes before and after it are one submap, as if a loop joined them.
struct TornTwice : Torn {
  explicit TornTwice(std::size_t last = 8, std::size_t count = 14) : Torn({3, last}, kTurnedAway, count) {
    for (std::size_t n = last + 1; n < truth.size(); ++n) {
      submaps[n] = submaps[0];
      poses[n] = truth[n];
    }
    for (Edge& doubt : doubts) {
      const Pose2 step = true_step(doubt.a);
      doubt.candidates = {scored(inverse(poses[doubt.a]) * poses[doubt.a + 1], -9.0), scored(step, -9.0)};
    }
  }
};

TEST(VerifyEdges, TakesTheCandidateThatParallelEdgesAgreeOn) {
  TornTwice map;
  const VerifiedMap both = map.verified(1.0);
  EXPECT_GT(both.edges[0].parallel_support[1], 0.0);
  EXPECT_EQ(both.edges[0].parallel_support[0], both.edges[1].parallel_support[0])
      << "where the map has it, both are the same as well";
  TornTwice alone;
  alone.doubts[1].candidates.pop_back();
  const VerifiedMap one = alone.verified(1.0);
  EXPECT_EQ(one.edges[0].parallel_support[1], 0.0);
  EXPECT_LT(one.edges[0].probability, both.edges[0].probability);
}

TEST(VerifyEdges, JoinsParallelEdgesTogether) {
  TornTwice map;
  map.doubts[0].candidates[1].score = 8.0;
  const VerifiedMap verified = map.verified();
  EXPECT_THAT(choices(verified), ElementsAre(1, 1));
  EXPECT_EQ(verified.edges[0].probability, verified.edges[1].probability);
  EXPECT_LT(test::worst_off_m(verified.map_from_node, map.truth), 1e-6);
}

TEST(VerifyEdges, LeavesOutParallelEdgesThatDisagree) {
  TornTwice map;
  map.doubts[0].candidates[1].score = 8.0;
  map.doubts[1].candidates[1].a_from_b = map.true_step(8) * kTooFar;
  const VerifiedMap verified = map.verified();
  EXPECT_THAT(choices(verified), ElementsAre(1, kCut));
  EXPECT_LE(verified.edges[1].probability, 1.0 - verified.edges[0].probability);
  EXPECT_THAT(verified.submap_of_node, Each(verified.submap_of_node.front()));
  EXPECT_LT(test::worst_off_m(verified.map_from_node, map.truth), 1e-6);
}

/// The two edges are too far apart to support each other, but must be joined together nevertheless.
TEST(VerifyEdges, JoinsParallelEdgesThatAreFarApart) {
  TornTwice map(24, 30);
  map.doubts[0].candidates[1].score = 8.0;
  map.doubts[1].candidates[1].a_from_b = map.true_step(24) * Pose2{0.5, 0.0, 0.0};
  const VerifiedMap verified = map.verified();
  EXPECT_THAT(choices(verified), ElementsAre(1, 1));
  EXPECT_EQ(verified.edges[0].parallel_support[1], 0.0);
  EXPECT_LT(test::worst_off_m(verified.map_from_node, map.truth), 1e-6);
}

/// An edge that was not verified yet stays, unless it contradicts an edge that joined two submaps.
TEST(VerifyEdges, StopsBetweenTwoEdgesThatContradictEachOther) {
  struct StopsAfter : RunObserver {
    explicit StopsAfter(int asked) : left(asked) {}
    bool keep_going() override { return left-- > 0; }
    int left;
  };
  TornTwice map;
  map.doubts[0].candidates[1].score = 8.0;
  map.doubts[1].candidates.pop_back();
  const auto chosen = [&](int asked) {
    StopsAfter observer(asked);
    return choices(verify_edges(map.views, {map.poses, map.submaps}, map.doubts, {{}, 0.7}, {1, observer}));
  };
  EXPECT_THAT(chosen(0), ElementsAre(0, 0));
  EXPECT_THAT(chosen(1), ElementsAre(1, kCut));
}

TEST(VerifyEdges, IsLessSureOfAPlaceThatTwoScansConstrainInNoDirection) {
  Torn map({6});
  map.doubts[0].candidates.push_back(scored(map.true_step(6), 0.0));
  const double held = map.verified().edges[0].probability;
  map.doubts[0].candidates[2].best_deviation_m = 10.0;
  EXPECT_LT(map.verified().edges[0].probability, held - 0.01);
}

TEST(VerifyEdges, StatesTheBestCandidateOfAnEdgeThatDoesNotJoin) {
  Torn map({6});
  map.doubts[0].candidates.push_back(scored(map.true_step(6), 0.0));
  const VerifiedEdge best = map.verified(1.0).edges[0];
  EXPECT_EQ(best.candidate, 2U);
  EXPECT_GT(best.probability, 0.5);
  EXPECT_FALSE(best.joins);
}

TEST(VerifyEdges, LeavesAllAsItWasWhenAskedToStop) {
  struct Impatient : RunObserver {
    bool keep_going() override { return false; }
  } impatient;
  Torn map({6});
  map.doubts[0].candidates.push_back(scored(map.true_step(6), 0.0));
  const VerifiedMap verified = verify_edges(map.views, {map.poses, map.submaps}, map.doubts, {{}, 0.7}, {1, impatient});
  EXPECT_THAT(choices(verified), ElementsAre(0));
  EXPECT_LT(test::worst_off_m(verified.map_from_node, map.poses), 1e-6);
}

TEST(VerifyEdges, IsTheSameToTheBitForAnyNumberOfThreads) {
  Torn map({3, 8});
  for (Edge& doubt : map.doubts) doubt.candidates.push_back(scored(map.true_step(doubt.a), 0.0));
  const VerifiedMap one = map.verified(0.7, 1);
  const VerifiedMap three = map.verified(0.7, 3);
  EXPECT_EQ(choices(one), choices(three));
  for (std::size_t n = 0; n < map.poses.size(); ++n)
    EXPECT_THAT(three.map_from_node[n], HasSameBits(one.map_from_node[n]));
}

}  // namespace
}  // namespace shapemap
