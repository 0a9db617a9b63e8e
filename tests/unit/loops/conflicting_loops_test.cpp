// SPDX-License-Identifier: GPL-3.0-or-later
#include "loops/conflicting_loops.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

LoopCluster cluster_of(const std::vector<std::pair<std::size_t, std::size_t>>& nodes, double log_odds) {
  LoopCluster cluster;
  for (const auto& [a, b] : nodes) cluster.members.push_back({a, b, {}, Eigen::Matrix3d::Identity(), log_odds});
  cluster.strength = 100.0;
  return cluster;
}

TEST(ConflictingLoops, ShareNodesAndHaveTheStrengthAtThese) {
  const std::vector<LoopCluster> clusters{
      cluster_of({{1, 50}, {2, 51}, {3, 52}}, 2.0),     // Each member is worth 4.
      cluster_of({{20, 51}, {21, 52}, {22, 53}}, 1.0),  // It shares nodes 51 and 52.
      cluster_of({{52, 80}, {53, 81}}, 0.0),            // It shares node 52, which is in its earlier stretch.
      cluster_of({{30, 60}, {31, 61}}, 5.0)};           // It shares no node.
  const std::vector<std::vector<ConflictingLoop>> rivals = conflicting_loops(clusters);
  ASSERT_EQ(rivals.size(), 4U);
  ASSERT_EQ(rivals[0].size(), 2U);
  EXPECT_EQ(rivals[0][0].cluster, 1U);
  EXPECT_DOUBLE_EQ(rivals[0][0].strength, 6.0);
  EXPECT_EQ(rivals[0][1].cluster, 2U);
  EXPECT_DOUBLE_EQ(rivals[0][1].strength, 2.0);
  EXPECT_EQ(rivals[1].size(), 2U);
  EXPECT_EQ(rivals[2].size(), 2U);
  EXPECT_TRUE(rivals[3].empty());
}

TEST(ConflictingLoops, AreNoStrongerThanTheirCluster) {
  std::vector<LoopCluster> clusters{cluster_of({{1, 50}, {2, 51}}, 2.0), cluster_of({{20, 50}, {21, 51}}, 4.0)};
  clusters[1].strength = 5.0;
  EXPECT_DOUBLE_EQ(conflicting_loops(clusters)[0][0].strength, 5.0);
  clusters[1].strength = 0.5;
  EXPECT_TRUE(conflicting_loops(clusters)[0].empty()) << "too weak";
  EXPECT_TRUE(conflicting_loops({}).empty());
}

/// Returns the strength of a conflicting loop, slowly: it asks for each node of each stretch by itself.
double by_each_node(const LoopCluster& one, const LoopCluster& other) {
  double strongest = 0.0;
  for (const bool later : {false, true}) {
    std::vector<std::size_t> nodes;
    for (const EdgeCandidate& member : one.members) nodes.push_back(later ? member.b : member.a);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    double sum = 0.0;
    for (const std::size_t n : nodes) {
      double best = 0.0;
      for (const EdgeCandidate& member : other.members) {
        if (member.a == n || member.b == n) best = std::max(best, worth_of_member(member));
      }
      sum += best;
    }
    strongest = std::max(strongest, sum);
  }
  return std::min(strongest, other.strength);
}

TEST(ConflictingLoops, AreThoseThatASlowSearchFinds) {
  std::mt19937 rng(7);
  std::uniform_int_distribution<std::size_t> node(0, 30);
  std::uniform_real_distribution<double> odds(-4.0, 5.0);
  for (int round = 0; round < 20; ++round) {
    std::vector<LoopCluster> clusters(8);
    for (LoopCluster& cluster : clusters) {
      for (int k = 0; k < 5; ++k) {
        const std::size_t a = node(rng);
        cluster.members.push_back({a, a + 1 + node(rng), {}, Eigen::Matrix3d::Identity(), odds(rng)});
      }
      cluster.strength = 5.0 + odds(rng);
    }
    const std::vector<std::vector<ConflictingLoop>> rivals = conflicting_loops(clusters);
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      for (std::size_t other = 0; other < clusters.size(); ++other) {
        const auto found = std::find_if(rivals[k].begin(), rivals[k].end(),
                                        [&](const ConflictingLoop& rival) { return rival.cluster == other; });
        const double expected = k == other ? 0.0 : by_each_node(clusters[k], clusters[other]);
        ASSERT_EQ(found != rivals[k].end(), expected > 1.0) << round << " " << k << " " << other;
        if (expected > 1.0) {
          ASSERT_NEAR(found->strength, expected, 1e-9);
        }
      }
    }
  }
}

}  // namespace
}  // namespace shapemap
