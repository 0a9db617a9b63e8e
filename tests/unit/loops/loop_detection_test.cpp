// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/loops/loop_detection.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "shapemap/core/errors.hpp"
#include "shapemap/matching/match_probability.hpp"
#include "support/matchers.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

using test::kRingLap;

using Pair = std::pair<std::size_t, std::size_t>;

std::set<Pair> pairs_of(const std::vector<EdgeCandidate>& candidates) {
  std::set<Pair> pairs;
  for (const EdgeCandidate& candidate : candidates) pairs.emplace(candidate.a, candidate.b);
  return pairs;
}

/// Returns a coarse search, which is enough here since these tests are not about the accuracy of matches.
MatchSearchOptions quick() {
  MatchSearchOptions search;
  search.candidates.rotation_peaks = 4;
  search.candidates.refined = 4;
  search.candidates.kept = 3;
  search.voting.peaks = 6;
  return search;
}

/// An observer that asks to stop after `times` questions, and notes the progress.
struct Patience : RunObserver {
  explicit Patience(std::size_t times) : left(times) {}
  bool keep_going() override { return left-- > 0; }
  void on_progress(std::size_t now_done, std::size_t of) override {
    EXPECT_GT(now_done, done);
    EXPECT_LE(now_done, of);
    done = now_done;
    total = of;
  }
  std::size_t left;
  std::size_t done = 0;
  std::size_t total = 0;
};

struct Ring {
  std::vector<Pose2> truth = test::ring_walk(kRingLap + 5, 2);
  test::Views views = test::views_along(test::ring_world(1), truth);
};

const Ring& ring() {
  static const Ring the_ring;
  return the_ring;
}

/// Returns a search without a cache.
LoopSearch by(const MatchSearchOptions& matching, const LoopDetectionOptions& detection, RunObserver& observer,
              int threads = 1) {
  return {matching, detection, {threads, observer}, nullptr};
}

TEST(LikelyLoops, FindsThePlacesThatWereSeenBefore) {
  const MatchSearchOptions matching = quick();
  RunObserver nobody;
  LoopDetectionOptions options;
  options.likely_places = 5;
  options.shortest_loop = 30;
  const std::vector<EdgeCandidate> found = likely_loops(ring().views, 0, by(matching, options, nobody));
  std::map<std::size_t, std::set<std::size_t>> places;
  std::set<std::size_t> right;
  for (const EdgeCandidate& loop : found) {
    ASSERT_LE(loop.a + 30, loop.b) << "too short a loop";
    ASSERT_LT(loop.b, ring().views.size());
    const double of_slipping = std::log(std::max(1.0, worst_deviation_m(loop.covariance) / 0.2));
    EXPECT_GE(1.0 / (1.0 + std::exp(-loop.score - of_slipping)), options.least_probability - 1e-9);
    EXPECT_GT(loop.covariance.determinant(), 0.0);
    places[loop.b].insert(loop.a);
    const Pose2 a_from_b = inverse(ring().truth[loop.a]) * ring().truth[loop.b];
    if (loop.score > 0.0 && testing::Value(loop.a_from_b, test::IsNearPose(a_from_b, 0.10, 2 * kDegree))) {
      right.insert(loop.b);
    }
  }
  for (const auto& [b, of_b] : places) EXPECT_LE(of_b.size(), 5U) << b;
  for (std::size_t b = kRingLap; b < kRingLap + 5; ++b) EXPECT_EQ(right.count(b), 1U) << b;
}

TEST(LikelyLoops, OfAWalkThatIsTooShortAreNone) {
  const MatchSearchOptions matching = quick();
  const LoopDetectionOptions detection;
  RunObserver nobody;
  const test::Views few(ring().views.begin(), ring().views.begin() + 10);
  EXPECT_TRUE(likely_loops(few, 0, by(matching, detection, nobody)).empty());
  EXPECT_TRUE(likely_loops({}, 0, by(matching, detection, nobody)).empty());
}

TEST(LikelyLoops, StopWhenTheObserverAsksTo) {
  const MatchSearchOptions matching = quick();
  LoopDetectionOptions options;
  options.likely_places = 4;
  Patience none(0);
  EXPECT_TRUE(likely_loops(ring().views, 0, by(matching, options, none)).empty());
  EXPECT_EQ(none.done, 0U);
  Patience one(1);
  const std::vector<EdgeCandidate> some = likely_loops(ring().views, 0, by(matching, options, one));
  EXPECT_GT(one.done, 0U);
  EXPECT_LT(one.done, one.total);
  RunObserver nobody;
  EXPECT_LT(some.size(), likely_loops(ring().views, 0, by(matching, options, nobody)).size());
}

/// A search of the first nodes and then of the others finds the same candidates as one of all nodes.
TEST(LikelyLoops, CanBeSearchedInParts) {
  const MatchSearchOptions matching = quick();
  LoopDetectionOptions options;
  options.likely_places = 2;
  RunObserver nobody;
  const std::vector<EdgeCandidate> all = likely_loops(ring().views, 0, by(matching, options, nobody));
  const NodeViews begin(ring().views.begin(), ring().views.begin() + 30);
  std::vector<EdgeCandidate> parts = likely_loops(begin, 0, by(matching, options, nobody));
  const std::size_t num_first = parts.size();
  for (const EdgeCandidate& loop : likely_loops(ring().views, 30, by(matching, options, nobody))) parts.push_back(loop);
  ASSERT_EQ(parts.size(), all.size());
  EXPECT_GT(num_first, 0U);
  EXPECT_LT(num_first, all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(parts[i].a, all[i].a);
    EXPECT_EQ(parts[i].b, all[i].b);
    EXPECT_EQ(parts[i].score, all[i].score);
  }
}

TEST(LikelyLoops, AreTheSameToTheBitForAnyNumberOfThreads) {
  const MatchSearchOptions matching = quick();
  RunObserver nobody;
  LoopDetectionOptions options;
  options.likely_places = 2;
  const std::vector<EdgeCandidate> one = likely_loops(ring().views, 0, by(matching, options, nobody));
  const std::vector<EdgeCandidate> three = likely_loops(ring().views, 0, by(matching, options, nobody, 3));
  ASSERT_EQ(one.size(), three.size());
  ASSERT_FALSE(one.empty());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].a, three[i].a);
    EXPECT_EQ(one[i].b, three[i].b);
    EXPECT_EQ(one[i].score, three[i].score);
    EXPECT_THAT(one[i].a_from_b, test::HasSameBits(three[i].a_from_b));
  }
}

TEST(CrossEdgeMatches, JoinTheNodesBeforeAnEdgeToThoseAfterIt) {
  const MatchSearchOptions matching = quick();
  const LoopDetectionOptions detection;
  RunObserver nobody;
  const test::Views few(ring().views.begin(), ring().views.begin() + 12);
  std::set<Pair> expected;
  for (std::size_t a = 2; a <= 5; ++a) {
    for (std::size_t b = 6; b <= 9; ++b) expected.emplace(a, b);
  }
  EXPECT_EQ(pairs_of(cross_edge_matches(few, {5}, by(matching, detection, nobody))), expected);
  EXPECT_EQ(pairs_of(cross_edge_matches(few, {0}, by(matching, detection, nobody))),
            (std::set<Pair>{{0, 1}, {0, 2}, {0, 3}, {0, 4}}));
  EXPECT_EQ(pairs_of(cross_edge_matches(few, {10}, by(matching, detection, nobody))),
            (std::set<Pair>{{7, 11}, {8, 11}, {9, 11}, {10, 11}}));
  EXPECT_TRUE(cross_edge_matches(few, {}, by(matching, detection, nobody)).empty());
}

TEST(CrossEdgeMatches, FindTheStepAcross) {
  const MatchSearchOptions matching;
  const LoopDetectionOptions detection;
  RunObserver nobody;
  const test::Views few(ring().views.begin(), ring().views.begin() + 12);
  int right = 0;
  for (const EdgeCandidate& bridge : cross_edge_matches(few, {5}, by(matching, detection, nobody))) {
    const Pose2 a_from_b = inverse(ring().truth[bridge.a]) * ring().truth[bridge.b];
    if (testing::Value(bridge.a_from_b, test::IsNearPose(a_from_b, 0.10, 2 * kDegree))) ++right;
  }
  EXPECT_GE(right, 12) << "of 16 pairs";
}

TEST(CrossEdgeMatches, StopWhenTheObserverAsksTo) {
  const MatchSearchOptions matching = quick();
  const LoopDetectionOptions detection;
  Patience none(0);
  EXPECT_THROW(cross_edge_matches(ring().views, {5}, by(matching, detection, none)), Interrupted);
}

}  // namespace
}  // namespace shapemap
