// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/loops/loop_clusters.hpp"
#include "loops_numbers.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace shapemap {
namespace {

std::size_t apart(std::size_t i, std::size_t j) { return i < j ? j - i : i - j; }

class Clustering {
 public:
  Clustering(const std::vector<EdgeCandidate>& candidates, const std::vector<Pose2>& map_from_node,
             const std::vector<std::size_t>& submap_of_node, const ClusterOptions& options)
      : candidates_(candidates),
        map_from_node_(map_from_node),
        submap_of_node_(submap_of_node),
        options_(options),
        order_(candidates.size()),
        cluster_(candidates.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::iota(cluster_.begin(), cluster_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t i, std::size_t j) { return candidates_[i].b < candidates_[j].b; });
  }

  std::vector<LoopCluster> clusters() {
    const auto window = static_cast<std::size_t>(options_.window);
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const EdgeCandidate& one = candidates_[order_[i]];
      for (std::size_t j = i + 1; j < order_.size(); ++j) {
        const EdgeCandidate& other = candidates_[order_[j]];
        if (other.b - one.b > window) break;
        if (apart(one.a, other.a) <= window && say_the_same(one, other)) join(order_[i], order_[j]);
      }
    }
    std::map<std::size_t, LoopCluster> by_root;
    for (std::size_t i = 0; i < candidates_.size(); ++i) by_root[root(i)].members.push_back(candidates_[i]);
    std::vector<LoopCluster> result;
    for (auto& [unused, cluster] : by_root) {
      rate(cluster);
      const auto least = static_cast<std::size_t>(options_.least_nodes);
      if (cluster.num_a >= least && cluster.num_b >= least) result.push_back(std::move(cluster));
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const LoopCluster& a, const LoopCluster& b) { return a.strength > b.strength; });
    return result;
  }

 private:
  bool say_the_same(const EdgeCandidate& one, const EdgeCandidate& other) const {
    if (submap_of_node_[one.a] != submap_of_node_[other.a] || submap_of_node_[one.b] != submap_of_node_[other.b]) {
      return false;
    }
    const Pose2 other_a_from_a = inverse(map_from_node_[other.a]) * map_from_node_[one.a];
    const Pose2 b_from_other_b = inverse(map_from_node_[one.b]) * map_from_node_[other.b];
    return agrees(other.a_from_b, other_a_from_a * one.a_from_b * b_from_other_b, options_.same);
  }

  std::size_t root(std::size_t i) {
    while (cluster_[i] != i) i = cluster_[i] = cluster_[cluster_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    const std::size_t a = root(i);
    const std::size_t b = root(j);
    cluster_[std::max(a, b)] = std::min(a, b);
  }

  static void rate(LoopCluster& cluster) {
    std::stable_sort(cluster.members.begin(), cluster.members.end(),
                     [](const EdgeCandidate& a, const EdgeCandidate& b) { return a.score > b.score; });
    std::set<std::size_t> of_a;
    std::set<std::size_t> of_b;
    double by_a = 0.0;
    double by_b = 0.0;
    for (const EdgeCandidate& member : cluster.members) {
      const double worth = worth_of_member(member);
      if (of_a.insert(member.a).second) by_a += worth;
      if (of_b.insert(member.b).second) by_b += worth;
    }
    cluster.num_a = of_a.size();
    cluster.num_b = of_b.size();
    cluster.strength = std::min(by_a, by_b);
  }

  const std::vector<EdgeCandidate>& candidates_;
  const std::vector<Pose2>& map_from_node_;
  const std::vector<std::size_t>& submap_of_node_;
  const ClusterOptions& options_;
  std::vector<std::size_t> order_;
  std::vector<std::size_t> cluster_;
};

}  // namespace

double worth_among_others(double log_odds) {
  return std::clamp(log_odds + kLoops.members.prior, 0.0, kLoops.members.most);
}

double worth_of_member(const EdgeCandidate& member) { return worth_among_others(member.score); }

std::vector<LoopCluster> loop_clusters(const std::vector<EdgeCandidate>& candidates,
                                       const std::vector<Pose2>& map_from_node,
                                       const std::vector<std::size_t>& submap_of_node, const ClusterOptions& options) {
  return Clustering(candidates, map_from_node, submap_of_node, options).clusters();
}

}  // namespace shapemap
