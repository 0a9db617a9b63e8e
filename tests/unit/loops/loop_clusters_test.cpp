// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/loops/loop_clusters.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "support/random_graph.hpp"

namespace shapemap {
namespace {

using Key = std::tuple<std::size_t, std::size_t, double>;  // No two candidates of a test have the same log odds.

Key key_of(const EdgeCandidate& candidate) { return {candidate.a, candidate.b, candidate.score}; }

std::set<Key> keys_of(const LoopCluster& cluster) {
  std::set<Key> keys;
  for (const EdgeCandidate& member : cluster.members) keys.insert(key_of(member));
  return keys;
}

std::set<std::set<Key>> keys_of(const std::vector<LoopCluster>& clusters) {
  std::set<std::set<Key>> keys;
  for (const LoopCluster& cluster : clusters) keys.insert(keys_of(cluster));
  return keys;
}

/// A walk of 60 nodes that comes to the places of nodes 5 to 14 again from node 40 on.
struct Way {
  explicit Way(unsigned seed) : rng(seed) {
    poses = test::random_walk(rng, 60);
    submaps.assign(poses.size(), 0);
  }

  /// Returns a candidate with a random error of its own, for a map that is bent by `bend` between the two stretches.
  EdgeCandidate candidate(std::size_t a, std::size_t b, const Pose2& bend, double error) {
    std::uniform_real_distribution<double> log_odds(-3.0, 6.0);
    const Pose2 a_from_b = inverse(poses[a]) * bend * poses[b] * test::random_pose(rng, error, error);
    return {a, b, a_from_b, Eigen::Matrix3d::Identity(), log_odds(rng)};
  }

  std::vector<EdgeCandidate> planted(const Pose2& bend) {
    std::vector<EdgeCandidate> candidates;
    for (std::size_t k = 0; k < 10; ++k) candidates.push_back(candidate(5 + k, 40 + k, bend, 0.01));
    return candidates;
  }

  std::mt19937 rng;
  std::vector<Pose2> poses;
  std::vector<std::size_t> submaps;
};

TEST(LoopClusters, HoldWhatIsConsistentAndLeaveOutWhatIsNot) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Way way(seed);
    const Pose2 bend = test::random_pose(way.rng, 3.0, kPi);
    std::vector<EdgeCandidate> candidates = way.planted(bend);
    std::set<Key> expected;
    for (const EdgeCandidate& candidate : candidates) expected.insert(key_of(candidate));
    for (std::size_t k = 0; k < 10; ++k) {  // None of these agrees with any other.
      const Pose2 wrong = bend * Pose2{2.0 + 3.0 * static_cast<double>(k), 0.0, 0.0};
      candidates.push_back(way.candidate(5 + k, 40 + k, wrong, 0.0));
    }
    const std::vector<LoopCluster> clusters = loop_clusters(candidates, way.poses, way.submaps, {});
    ASSERT_EQ(clusters.size(), 1U) << seed;
    EXPECT_EQ(keys_of(clusters[0]), expected) << seed;
    EXPECT_EQ(clusters[0].num_a, 10U);
    EXPECT_EQ(clusters[0].num_b, 10U);
    EXPECT_TRUE(std::is_sorted(clusters[0].members.begin(), clusters[0].members.end(),
                               [](const EdgeCandidate& x, const EdgeCandidate& y) { return x.score > y.score; }));
  }
}

TEST(LoopClusters, DoNotReachFromOneSubmapToTheNext) {
  Way way(1);
  const std::vector<EdgeCandidate> candidates = way.planted({1.0, 0.0, 0.5});
  ASSERT_EQ(loop_clusters(candidates, way.poses, way.submaps, {}).size(), 1U);
  const auto cut_at = [&](std::size_t node) {
    std::vector<std::size_t> submaps(way.poses.size(), 0);
    for (std::size_t n = node; n < submaps.size(); ++n) submaps[n] = 1;
    return submaps;
  };
  const std::vector<LoopCluster> two_first = loop_clusters(candidates, way.poses, cut_at(8), {});
  ASSERT_EQ(two_first.size(), 2U) << "nodes 5 to 7, and the seven after";
  EXPECT_THAT((std::set<std::size_t>{two_first[0].num_a, two_first[1].num_a}), testing::ElementsAre(3, 7));
  const std::vector<LoopCluster> two_last = loop_clusters(candidates, way.poses, cut_at(44), {});
  ASSERT_EQ(two_last.size(), 2U) << "nodes 40 to 43, and the six after";
  EXPECT_EQ(two_last[0].num_b + two_last[1].num_b, 10U);
  EXPECT_EQ(loop_clusters(candidates, way.poses, cut_at(20), {}).size(), 1U) << "a cut between the two stretches";
}

TEST(LoopClusters, NeedSeveralNodesOnEitherSide) {
  Way way(2);
  std::vector<EdgeCandidate> candidates;
  for (std::size_t k = 0; k < 4; ++k) candidates.push_back(way.candidate(5, 40 + k, {}, 0.0));
  EXPECT_TRUE(loop_clusters(candidates, way.poses, way.submaps, {}).empty()) << "all of it hangs on one scan";
  candidates.push_back(way.candidate(6, 41, {}, 0.0));
  EXPECT_EQ(loop_clusters(candidates, way.poses, way.submaps, {}).size(), 1U);
  ClusterOptions options;
  options.least_nodes = 3;
  EXPECT_TRUE(loop_clusters(candidates, way.poses, way.submaps, options).empty());
  EXPECT_TRUE(loop_clusters({}, way.poses, way.submaps, {}).empty());
}

/// Returns candidates that are so near to each other that all cases occur.
std::vector<EdgeCandidate> random_candidates(Way& way, std::size_t count) {
  const std::vector<Pose2> bends{{}, {0.3, 0.0, 0.0}, {0.0, 0.0, 0.08}, {5.0, 1.0, 1.0}};
  std::uniform_int_distribution<std::size_t> first(0, 20);
  std::uniform_int_distribution<std::size_t> last(35, 59);
  std::uniform_int_distribution<std::size_t> any(0, bends.size() - 1);
  std::vector<EdgeCandidate> candidates;
  while (candidates.size() < count) {
    const std::size_t a = first(way.rng);
    const std::size_t b = last(way.rng);
    candidates.push_back(way.candidate(a, b, bends[any(way.rng)], 0.05));
  }
  return candidates;
}

/// Returns whether two candidates support each other: their nodes are near each other, and their relative poses agree
/// by way of the map.
bool support(const Way& way, const EdgeCandidate& x, const EdgeCandidate& y, const ClusterOptions& options) {
  const EdgeCandidate& one = x.b <= y.b ? x : y;
  const EdgeCandidate& other = x.b <= y.b ? y : x;
  const auto window = static_cast<double>(options.window);
  if (std::abs(static_cast<double>(one.a) - static_cast<double>(other.a)) > window ||
      static_cast<double>(other.b - one.b) > window || way.submaps[one.a] != way.submaps[other.a] ||
      way.submaps[one.b] != way.submaps[other.b]) {
    return false;
  }
  const Pose2 by_detour =
      inverse(way.poses[other.a]) * way.poses[one.a] * one.a_from_b * inverse(way.poses[one.b]) * way.poses[other.b];
  const Pose2 off = inverse(other.a_from_b) * by_detour;
  return std::hypot(off.x_m, off.y_m) < options.same.m && std::abs(off.theta_rad) < options.same.rad;
}

/// Returns the groups of candidates that support each other, by flood fill.
std::set<std::set<Key>> by_flood_fill(const Way& way, const std::vector<EdgeCandidate>& candidates,
                                      const ClusterOptions& options) {
  std::set<std::set<Key>> groups;
  std::vector<bool> seen(candidates.size(), false);
  for (std::size_t first = 0; first < candidates.size(); ++first) {
    if (seen[first]) continue;
    std::vector<std::size_t> group{first};
    seen[first] = true;
    for (std::size_t g = 0; g < group.size(); ++g) {
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (seen[i] || !support(way, candidates[group[g]], candidates[i], options)) continue;
        seen[i] = true;
        group.push_back(i);
      }
    }
    std::set<Key> keys;
    std::set<std::size_t> of_a;
    std::set<std::size_t> of_b;
    for (const std::size_t i : group) {
      keys.insert(key_of(candidates[i]));
      of_a.insert(candidates[i].a);
      of_b.insert(candidates[i].b);
    }
    const auto least = static_cast<std::size_t>(options.least_nodes);
    if (of_a.size() >= least && of_b.size() >= least) groups.insert(keys);
  }
  return groups;
}

TEST(LoopClusters, AreTheGroupsThatAFloodFillFindsWhateverTheOrder) {
  std::size_t num_clusters = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    Way way(seed);
    for (std::size_t node = 10 + seed % 5; node < way.submaps.size(); ++node) way.submaps[node] = node < 48 ? 1 : 2;
    std::vector<EdgeCandidate> candidates = random_candidates(way, 20 + 4 * seed);
    ClusterOptions options;
    options.window = 1 + static_cast<int>(seed % 5);
    const std::set<std::set<Key>> expected = by_flood_fill(way, candidates, options);
    num_clusters += expected.size();
    for (int order = 0; order < 4; ++order) {
      EXPECT_EQ(keys_of(loop_clusters(candidates, way.poses, way.submaps, options)), expected) << seed;
      std::shuffle(candidates.begin(), candidates.end(), way.rng);
    }
  }
  EXPECT_GT(num_clusters, 60U);
}

TEST(LoopClusters, AreAsStrongAsTheirWeakerSideAndTheStrongestComesFirst) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Way way(seed);
    const std::vector<LoopCluster> clusters = loop_clusters(random_candidates(way, 120), way.poses, way.submaps, {});
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      std::map<std::size_t, double> by_a;
      std::map<std::size_t, double> by_b;
      for (const EdgeCandidate& member : clusters[k].members) {
        const double worth = std::min(6.0, std::max(0.0, member.score + 2.0));
        by_a[member.a] = std::max(by_a[member.a], worth);
        by_b[member.b] = std::max(by_b[member.b], worth);
      }
      double sum_a = 0.0;
      double sum_b = 0.0;
      for (const auto& [node, worth] : by_a) sum_a += worth;
      for (const auto& [node, worth] : by_b) sum_b += worth;
      EXPECT_NEAR(clusters[k].strength, std::min(sum_a, sum_b), 1e-9);
      EXPECT_EQ(clusters[k].num_a, by_a.size());
      EXPECT_EQ(clusters[k].num_b, by_b.size());
      if (k > 0) {
        EXPECT_LE(clusters[k].strength, clusters[k - 1].strength);
      }
    }
  }
}

}  // namespace
}  // namespace shapemap
