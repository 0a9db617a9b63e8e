// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/loops/perceptual_aliasing.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

/// A walk along a line with steps of a metre, whose edges are all sure.
struct Walk {
  Walk() {
    for (std::size_t n = 0; n < 60; ++n) map.push_back({static_cast<double>(n), 0.0, 0.0});
    edges = test::drifting_edges(map, 0.0);
    for (Edge& edge : edges) edge.probability = 0.99;
  }

  EdgeCandidate loop(std::size_t a, std::size_t b, const Pose2& a_from_b, double log_odds) const {
    return {a, b, a_from_b, test::covariance_of(0.05, 1 * kDegree), log_odds};
  }
  /// Returns a candidate with the relative pose of the map.
  EdgeCandidate right(std::size_t a, std::size_t b, double log_odds) const {
    return loop(a, b, inverse(map[a]) * map[b], log_odds);
  }
  std::vector<EdgeCandidate> of(const std::vector<EdgeCandidate>& candidates, double sure_probability = 0.97) const {
    return without_aliases(candidates, edges, map, sure_probability);
  }

  std::vector<Pose2> map;
  std::vector<Edge> edges;
};

TEST(PerceptualAliasing, WhereNothingIsContradictedAllIsKept) {
  const Walk walk;
  const std::vector<EdgeCandidate> kept = walk.of({walk.right(3, 15, 4.0), walk.loop(2, 55, {}, 1.0)});
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].score, 4.0);
  EXPECT_EQ(kept[1].score, 1.0) << "the chain is not sure of what is so far apart";
}

TEST(PerceptualAliasing, WhatOdometryContradictsIsLeftOutAndCountsAgainstTheOthersThere) {
  const Walk walk;
  const std::vector<EdgeCandidate> kept = walk.of({walk.loop(10, 22, {0.1, 0.0, 0.0}, 3.0), walk.loop(3, 52, {}, 6.0),
                                                   walk.loop(8, 58, {}, 6.0), walk.loop(4, 24, {20.0, 0.0, 0.0}, 2.0)});
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[0].score, 6.0) << "far from both";
  EXPECT_NEAR(kept[1].score, 1.0, 1e-12) << "two nodes from the one";
  EXPECT_NEAR(kept[2].score, -3.0, 1e-12) << "two nodes from the other, though the chain agrees";
}

TEST(PerceptualAliasing, ATurnIsContradictedAsWell) {
  const Walk walk;
  EXPECT_TRUE(walk.of({walk.loop(10, 20, {10.0, 0.0, 180 * kDegree}, 3.0)}).empty());
  EXPECT_EQ(walk.of({walk.loop(10, 20, {10.0, 0.0, 20 * kDegree}, 3.0)}).size(), 1U);
}

TEST(PerceptualAliasing, HowSureAnEdgeMustBeToContradictIsForTheCallerToSay) {
  const Walk walk;
  const std::vector<EdgeCandidate> wrong{walk.loop(10, 22, {0.1, 0.0, 0.0}, 3.0)};
  EXPECT_TRUE(walk.of(wrong, 0.99).empty()) << "as sure as the edges are";
  EXPECT_EQ(walk.of(wrong, 0.995).size(), 1U);
}

TEST(PerceptualAliasing, ADoubtfulEdgeOrOneThatSlidesContradictsNothing) {
  const EdgeCandidate off = Walk().loop(10, 22, {}, 3.0);
  Walk doubtful;
  doubtful.edges[15].probability = 0.9;
  EXPECT_EQ(doubtful.of({off}).size(), 1U);
  Walk sliding;
  sliding.edges[15].candidates.front().covariance(0, 0) = 9.0;
  EXPECT_EQ(sliding.of({off}).size(), 1U);
  Walk gap;
  gap.edges[15] = {};
  EXPECT_EQ(gap.of({off}).size(), 1U);
}

TEST(PerceptualAliasing, NeedsAMapOfOdometry) {
  Walk walk;
  walk.map.pop_back();
  EXPECT_THROW(walk.of({}), std::invalid_argument);
  EXPECT_TRUE(without_aliases({}, {}, {}, 0.97).empty());
}

}  // namespace
}  // namespace shapemap
