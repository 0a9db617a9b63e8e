// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "shapemap/graph/pose_graph.hpp"

namespace shapemap {
namespace {

using ::testing::ElementsAre;

PoseConstraint edge(std::size_t a, std::size_t b) { return {a, b, {}, Eigen::Matrix3d::Identity(), 0.0}; }

/// Returns edges between random nodes, some of which are joined several times.
std::vector<PoseConstraint> random_multigraph(std::mt19937& rng, std::size_t num_nodes, std::size_t num_edges) {
  std::uniform_int_distribution<std::size_t> any(0, num_nodes - 1);
  std::bernoulli_distribution again(0.2);
  std::vector<PoseConstraint> edges;
  while (edges.size() < num_edges) {
    if (!edges.empty() && again(rng)) {
      const PoseConstraint& other = edges[any(rng) % edges.size()];
      edges.push_back(edge(other.b, other.a));
      continue;
    }
    const std::size_t a = any(rng);
    const std::size_t b = any(rng);
    if (a != b) edges.push_back(edge(a, b));
  }
  return edges;
}

/// Returns which nodes can be reached from `first` without edge number `without`.
std::vector<bool> flooded(std::size_t num_nodes, const std::vector<PoseConstraint>& edges, std::size_t first,
                          std::size_t without) {
  std::vector<bool> reached(num_nodes, false);
  reached[first] = true;
  for (bool more = true; more;) {
    more = false;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (e == without || reached[edges[e].a] == reached[edges[e].b]) continue;
      reached[edges[e].a] = reached[edges[e].b] = true;
      more = true;
    }
  }
  return reached;
}

/// Checks sparse graphs, which have many components and many bridges, and dense ones.
template <class Check>
void on_random_graphs(const Check& check) {
  std::mt19937 rng(1);
  for (std::size_t round = 0; round < 400; ++round) {
    const std::size_t num_nodes = 2 + round % 14;
    const std::size_t num_edges = (round / 14) % (2 * num_nodes);
    check(num_nodes, random_multigraph(rng, num_nodes, num_edges));
  }
}

TEST(ConnectedComponents, AreThoseOfAFloodFill) {
  on_random_graphs([](std::size_t num_nodes, const std::vector<PoseConstraint>& edges) {
    const std::vector<std::size_t> part = connected_components(num_nodes, edges);
    ASSERT_EQ(part.size(), num_nodes);
    for (std::size_t node = 0; node < num_nodes; ++node) {
      const std::vector<bool> reached = flooded(num_nodes, edges, node, edges.size());
      std::size_t lowest = 0;
      while (!reached[lowest]) ++lowest;
      EXPECT_EQ(part[node], lowest);
    }
  });
}

TEST(ConnectedComponents, DoNotDependOnTheOrderOfTheConstraints) {
  std::mt19937 rng(2);
  for (int round = 0; round < 50; ++round) {
    std::vector<PoseConstraint> edges = random_multigraph(rng, 30, 20);
    const std::vector<std::size_t> part = connected_components(30, edges);
    std::shuffle(edges.begin(), edges.end(), rng);
    EXPECT_EQ(connected_components(30, edges), part);
  }
}

TEST(BridgeEdges, AreThoseWithoutWhichTheirNodesAreDisconnected) {
  int num_lone = 0;
  int num_held = 0;
  on_random_graphs([&](std::size_t num_nodes, const std::vector<PoseConstraint>& edges) {
    const std::vector<bool> lone = bridge_edges(num_nodes, edges);
    ASSERT_EQ(lone.size(), edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      EXPECT_EQ(lone[e], !flooded(num_nodes, edges, edges[e].a, e)[edges[e].b]) << "edge " << e;
      ++(lone[e] ? num_lone : num_held);
    }
  });
  EXPECT_GT(num_lone, 100);
  EXPECT_GT(num_held, 100);
}

TEST(BridgeEdges, IncludeNoParallelEdges) {
  EXPECT_THAT(bridge_edges(3, {edge(0, 1), edge(1, 2)}), ElementsAre(true, true));
  EXPECT_THAT(bridge_edges(3, {edge(0, 1), edge(1, 2), edge(1, 0)}), ElementsAre(false, true, false));
  EXPECT_THAT(bridge_edges(3, {edge(0, 1), edge(1, 2), edge(0, 2)}), ElementsAre(false, false, false));
}

TEST(Connectivity, OfALongGraphNeedsNoDeepStack) {
  constexpr std::size_t kMany = 300000;
  std::vector<PoseConstraint> chain;
  for (std::size_t i = 0; i + 1 < kMany; ++i) chain.push_back(edge(i, i + 1));
  EXPECT_EQ(bridge_edges(kMany, chain), std::vector<bool>(kMany - 1, true));
  EXPECT_EQ(connected_components(kMany, chain), std::vector<std::size_t>(kMany, 0));
  chain.push_back(edge(kMany - 1, 0));
  EXPECT_EQ(bridge_edges(kMany, chain), std::vector<bool>(kMany, false));
}

TEST(Connectivity, RefusesNodesThatDoNotExist) {
  EXPECT_TRUE(connected_components(0, {}).empty());
  EXPECT_TRUE(bridge_edges(0, {}).empty());
  for (const PoseConstraint& bad : {edge(0, 2), edge(2, 0), edge(1, 1)}) {
    EXPECT_THROW(connected_components(2, {bad}), std::invalid_argument);
    EXPECT_THROW(bridge_edges(2, {bad}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace shapemap
