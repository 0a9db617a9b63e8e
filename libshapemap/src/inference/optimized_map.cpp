// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimized_map.hpp"

#include <algorithm>
#include <cmath>

#include "loops/loop_candidates.hpp"
#include "shapemap/inference/map_refinement.hpp"
#include "shapemap/inference/map_search.hpp"
#include "shapemap/loops/perceptual_aliasing.hpp"

namespace shapemap {
namespace {

/// Within a piece of the chain that has no less probable link, poses are good enough to compare loops.
constexpr double kTrusted = 0.5;

/// A loop that is closed stays in the graph by so many of its alignments, while all neighbours are aligned anew.
constexpr std::size_t kMembersKept = 3;
constexpr double kLoopLoss = 2.0;

/// Fills in what hangs together, and by what.
void find_parts(const KeyframeChain& chain, const std::vector<PoseConstraint>& loops, Improbable improbable,
                const RobustOptions& options, KeyframeMap& map) {
  const std::size_t count = chain.keyframes.size();
  map.held_by_loops.assign(chain.links.size(), false);
  std::vector<PoseConstraint> constraints = link_constraints(chain, map.link_choice);
  constraints.insert(constraints.end(), loops.begin(), loops.end());
  const std::vector<bool> lone = lone_constraints(count, constraints);
  std::size_t next = 0;
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    if (map.link_choice[i] == kCut) continue;
    const bool alone = lone[next++];
    map.held_by_loops[i] = !alone;
    if (!alone || improbable == Improbable::kStays) continue;
    if (stated_probability(chain.links[i]) < options.front_end.split_below) map.link_choice[i] = kCut;
  }
  constraints = link_constraints(chain, map.link_choice);
  constraints.insert(constraints.end(), loops.begin(), loops.end());
  map.component = connected_parts(count, constraints);
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    if (map.link_choice[i] == kCut) map.held_by_loops[i] = map.component[i] == map.component[i + 1];
  }
}

/// For each keyframe, the piece of the chain that it is in, by number.
std::vector<std::size_t> trusted_pieces(const std::vector<ChainLink>& links) {
  std::vector<std::size_t> piece(links.size() + 1, 0);
  for (std::size_t i = 0; i < links.size(); ++i) {
    piece[i + 1] = piece[i] + (links[i].exists() && links[i].probability >= kTrusted ? 0 : 1);
  }
  return piece;
}

std::vector<PoseConstraint> loop_constraints(const std::vector<LoopCluster>& clusters,
                                             const std::vector<std::size_t>& accepted) {
  std::vector<PoseConstraint> constraints;
  for (const std::size_t k : accepted) {
    const std::vector<LoopHypothesis>& members = clusters[k].members;
    for (std::size_t m = 0; m < std::min(kMembersKept, members.size()); ++m) {
      constraints.push_back({members[m].a, members[m].b, members[m].a_from_b, members[m].covariance, kLoopLoss});
    }
  }
  return constraints;
}

/// Whether the map is at all what a loop says: robust losses let all others outvote one that is wrong.
bool is_closed(const LoopCluster& cluster, const std::vector<Pose2>& map_from_keyframe) {
  const LoopHypothesis& best = cluster.members.front();
  const Pose2 off = inverse(best.a_from_b) * (inverse(map_from_keyframe[best.a]) * map_from_keyframe[best.b]);
  return is_within(off, kContradicts_m, kContradicts_rad);
}

ClosedLoop closed_loop(const KeyframeChain& chain, const LoopCluster& cluster) {
  const LoopHypothesis& best = cluster.members.front();
  return {chain.keyframes[best.a].position_index, chain.keyframes[best.b].position_index, best.a_from_b,
          cluster.strength};
}

}  // namespace

std::vector<PoseConstraint> link_constraints(const KeyframeChain& chain, const std::vector<int>& link_choice) {
  std::vector<PoseConstraint> constraints;
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    if (link_choice[i] == kCut) continue;
    constraints.push_back(link_constraint(chain, i, static_cast<std::size_t>(link_choice[i])));
  }
  return constraints;
}

KeyframeMap map_of_chain(const KeyframeChain& chain, const RobustOptions& options) {
  KeyframeMap map;
  map.map_from_keyframe.resize(chain.keyframes.size());
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    const KeyframeLink& link = chain.links[i];
    map.link_choice.push_back(link.hypotheses.empty() ? kCut : static_cast<int>(link.choice.alternative));
    if (link.hypotheses.empty()) continue;
    map.map_from_keyframe[i + 1] = map.map_from_keyframe[i] * link.hypotheses[link.choice.alternative].ref_from_query;
  }
  find_parts(chain, {}, Improbable::kIsCut, options, map);
  return map;
}

KeyframeMap map_with_loops(const KeyframeChain& chain, const std::vector<LoopHypothesis>& found, Improbable improbable,
                           const RobustOptions& options, const Execution& execution) {
  RunObserver& observer = execution.observer;
  observer.on_stage("whole map");
  KeyframeMap map = map_of_chain(chain, options);
  const NodeViews views = views_of(chain);
  const std::vector<ChainLink> links = chain_links(chain);
  const std::vector<LoopHypothesis> hypotheses = without_look_alikes(found, links, map.map_from_keyframe);
  const std::vector<LoopCluster> clusters = loop_clusters(hypotheses, map.map_from_keyframe, trusted_pieces(links), {});
  const VisibilityOptions& visibility = options.matcher.search.visibility;
  const LoopSolution solution =
      close_loops(views, links, hypotheses, clusters, visibility, options.map_search, execution.threads, observer);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const int rank = solution.link_choice[i];
    map.link_choice[i] =
        rank == kCut ? kCut : static_cast<int>(ranked_hypothesis(chain.links[i], static_cast<std::size_t>(rank)));
  }
  const std::vector<PoseConstraint> loops = loop_constraints(clusters, solution.accepted);
  find_parts(chain, loops, improbable, options, map);
  map.constraints = link_constraints(chain, map.link_choice);
  map.constraints.insert(map.constraints.end(), loops.begin(), loops.end());
  RefinedMap refined = refine_map(views, solution.map_from_node, map.constraints, options.matcher.search,
                                  options.refinement, execution.threads, observer);
  map.map_from_keyframe = std::move(refined.map_from_node);
  map.constraints.insert(map.constraints.end(), refined.neighbours.begin(), refined.neighbours.end());
  for (const std::size_t k : solution.accepted) {
    if (is_closed(clusters[k], map.map_from_keyframe)) map.loops.push_back(closed_loop(chain, clusters[k]));
  }
  return map;
}

}  // namespace shapemap
