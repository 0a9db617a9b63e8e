// SPDX-License-Identifier: GPL-3.0-or-later
#include "conflicting_loops.hpp"
#include "loops_numbers.hpp"

#include <algorithm>
#include <map>

namespace shapemap {
namespace {

using WorthOfNodes = std::map<std::size_t, double>;
using WorthOfClusters = std::map<std::size_t, double>;

/// The worth of the best member at each node, for both stretches of a cluster.
struct Stretches {
  WorthOfNodes a;
  WorthOfNodes b;
};

void keep_best(WorthOfNodes& best, std::size_t key, double worth) {
  const auto [found, unused] = best.try_emplace(key, 0.0);
  found->second = std::max(found->second, worth);
}

/// Returns for each cluster the worth of its members at the nodes of a stretch.
WorthOfClusters claims_on(const WorthOfNodes& stretch, const std::map<std::size_t, WorthOfClusters>& by_node) {
  WorthOfClusters claims;
  for (const auto& [node, unused] : stretch) {
    for (const auto& [cluster, worth] : by_node.at(node)) claims[cluster] += worth;
  }
  return claims;
}

}  // namespace

std::vector<std::vector<ConflictingLoop>> conflicting_loops(const std::vector<LoopCluster>& clusters) {
  std::vector<Stretches> stretches(clusters.size());
  std::map<std::size_t, WorthOfClusters> by_node;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    for (const EdgeCandidate& member : clusters[k].members) {
      const double worth = worth_of_member(member);
      keep_best(stretches[k].a, member.a, worth);
      keep_best(stretches[k].b, member.b, worth);
      keep_best(by_node[member.a], k, worth);
      keep_best(by_node[member.b], k, worth);
    }
  }
  std::vector<std::vector<ConflictingLoop>> rivals(clusters.size());
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    WorthOfClusters strongest;
    for (const WorthOfNodes* stretch : {&stretches[k].a, &stretches[k].b}) {
      for (const auto& [other, worth] : claims_on(*stretch, by_node)) keep_best(strongest, other, worth);
    }
    for (const auto& [other, worth] : strongest) {
      const double strength = std::min(worth, clusters[other].strength);
      if (other != k && strength > kLoops.conflicts.least_strength) rivals[k].push_back({other, strength});
    }
  }
  return rivals;
}

}  // namespace shapemap
