// SPDX-License-Identifier: GPL-3.0-or-later
#include "inference/optimized_map.hpp"

#include <gmock/gmock.h>

#include "shapemap/inference/map_search.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

/// A graph of three keyframes, each of whose edges is most likely wrong.
struct ImprobableEdges {
  ImprobableEdges() {
    for (const auto& view : test::views_along(test::ring_world(1), test::ring_walk(3, 2, 4.0))) {
      graph.keyframes.push_back({graph.keyframes.size(), 0, view, {}, {}});
    }
    graph.edges.resize(2);
    for (OdometryEdge& edge : graph.edges) {
      edge.candidates = {candidate_at(*graph.keyframes[0].view, *graph.keyframes[1].view, {3.0, 1.0, 1.0}, {})};
      edge.choice = {0, 0.0, {0.0}};
    }
  }

  std::vector<int> choices(Improbable improbable) const {
    RunObserver nobody;
    return optimized_map(graph, {}, improbable, options, {1, nobody}).edge_choice;
  }

  KeyframeGraph graph;
  RobustOptions options;
};

TEST(OptimizedMap, ImprobableEdgesOfOdometryAloneAreCut) {
  const ImprobableEdges walk;
  ASSERT_LT(stated_probability(walk.graph.edges[0]), walk.options.front_end.split_below);
  const OptimizedMap map = map_of_odometry(walk.graph, walk.options);
  EXPECT_THAT(map.edge_choice, Each(kCut));
  EXPECT_THAT(map.component, ElementsAre(0, 1, 2));
}

TEST(OptimizedMap, UnlessTheLimitIsLower) {
  ImprobableEdges walk;
  walk.options.front_end.split_below = 0.0;
  EXPECT_THAT(map_of_odometry(walk.graph, walk.options).edge_choice, Each(0));
}

TEST(OptimizedMap, WhereAllScansWillJudgeThemTheyStay) {
  const ImprobableEdges walk;
  EXPECT_THAT(walk.choices(Improbable::kIsCut), Each(kCut));
  EXPECT_THAT(walk.choices(Improbable::kStays), Each(0));
}

}  // namespace
}  // namespace shapemap
