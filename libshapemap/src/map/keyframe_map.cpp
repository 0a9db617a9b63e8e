// SPDX-License-Identifier: GPL-3.0-or-later
#include "keyframe_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "keyframe_store.hpp"
#include "shapemap/align/robust_align.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/graph/loop_closing.hpp"
#include "shapemap/graph/loop_hypotheses.hpp"
#include "shapemap/graph/map_refinement.hpp"

namespace shapemap {
namespace {

/// Within a piece of the chain that has no less probable link, poses are good enough to compare loops.
constexpr double kTrusted = 0.5;

/// A loop that is closed stays in the graph by so many of its alignments, while all neighbours are aligned anew.
constexpr std::size_t kMembersKept = 3;
constexpr double kLoopLoss = 2.0;

double probability(const KeyframeLink& link, const ConfidenceOptions& options) {
  return judged(link.hypotheses, link.choice.alternative, link.choice.margin, options).probability;
}

/// Index of hypothesis number `rank` of a link, when that which the chain chose comes first.
std::size_t ranked_hypothesis(const KeyframeLink& link, std::size_t rank) {
  if (rank == 0) return link.choice.alternative;
  return rank <= link.choice.alternative ? rank - 1 : rank;
}

ChainLink chain_link(const KeyframeLink& link, const ConfidenceOptions& options) {
  ChainLink result;
  for (std::size_t rank = 0; rank < link.hypotheses.size(); ++rank) {
    const PoseHypothesis& pose = link.hypotheses[ranked_hypothesis(link, rank)];
    result.alternatives.push_back({pose.ref_from_query, pose_covariance(pose.fit), pose.score});
  }
  if (result.exists()) result.probability = probability(link, options);
  return result;
}

std::vector<PoseConstraint> link_constraints(const KeyframeChain& chain, const std::vector<int>& link_choice) {
  std::vector<PoseConstraint> constraints;
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    if (link_choice[i] == kCut) continue;
    const PoseHypothesis& pose = chain.links[i].hypotheses[static_cast<std::size_t>(link_choice[i])];
    constraints.push_back({i, i + 1, pose.ref_from_query, pose_covariance(pose.fit), 0.0});
  }
  return constraints;
}

/// Fills in what hangs together, and by what. Improbable links that alone hold what comes after them are cut.
void find_parts(const KeyframeChain& chain, const std::vector<PoseConstraint>& loops, const MappingOptions& options,
                KeyframeMap& map) {
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
    if (alone && probability(chain.links[i], options.robust.confidence) < options.smoothing.split_below) {
      map.link_choice[i] = kCut;
    }
  }
  constraints = link_constraints(chain, map.link_choice);
  constraints.insert(constraints.end(), loops.begin(), loops.end());
  map.component = connected_parts(count, constraints);
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    if (map.link_choice[i] == kCut) map.held_by_loops[i] = map.component[i] == map.component[i + 1];
  }
}

std::vector<LoopHypothesis> loop_hypotheses(const NodeViews& views, const std::vector<ChainLink>& links,
                                            const MappingOptions& options, RunObserver& observer,
                                            AlignmentStore* store) {
  observer.on_stage("loops");
  std::vector<LoopHypothesis> hypotheses =
      likely_loops(views, options.robust.search, options.loop_search, options.chain.threads, observer, store);
  std::vector<std::size_t> doubtful;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].exists() && links[i].probability < options.loop_search.bridge_below) doubtful.push_back(i);
  }
  observer.on_stage("doubts");
  const std::vector<LoopHypothesis> around =
      bridges(views, doubtful, options.robust.search, options.chain.threads, observer, store);
  hypotheses.insert(hypotheses.end(), around.begin(), around.end());
  return hypotheses;
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
  constexpr double kFarOff_m = 1.0;
  constexpr double kFarOff_rad = 10 * kDegree;
  const LoopHypothesis& best = cluster.members.front();
  const Pose2 off = inverse(best.a_from_b) * (inverse(map_from_keyframe[best.a]) * map_from_keyframe[best.b]);
  return off.translation().norm() < kFarOff_m && std::abs(off.theta_rad) < kFarOff_rad;
}

ClosedLoop closed_loop(const KeyframeChain& chain, const LoopCluster& cluster) {
  const LoopHypothesis& best = cluster.members.front();
  return {chain.keyframes[best.a].position_index, chain.keyframes[best.b].position_index, best.a_from_b,
          cluster.strength};
}

}  // namespace

KeyframeMap map_of_chain(const KeyframeChain& chain, const MappingOptions& options) {
  KeyframeMap map;
  map.map_from_keyframe.resize(chain.keyframes.size());
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    const KeyframeLink& link = chain.links[i];
    map.link_choice.push_back(link.hypotheses.empty() ? kCut : static_cast<int>(link.choice.alternative));
    if (link.hypotheses.empty()) continue;
    map.map_from_keyframe[i + 1] = map.map_from_keyframe[i] * link.hypotheses[link.choice.alternative].ref_from_query;
  }
  find_parts(chain, {}, options, map);
  return map;
}

KeyframeMap map_with_loops(const KeyframeChain& chain, const MappingOptions& options, RunObserver& observer,
                           AlignmentStore* store) {
  KeyframeMap map = map_of_chain(chain, options);
  NodeViews views;
  for (const Keyframe& keyframe : chain.keyframes) views.push_back(keyframe.view);
  std::vector<ChainLink> links;
  for (const KeyframeLink& link : chain.links) links.push_back(chain_link(link, options.robust.confidence));

  std::optional<KeyframeStore> of_keyframes;
  if (store) of_keyframes.emplace(chain, *store);
  const std::vector<LoopHypothesis> hypotheses =
      loop_hypotheses(views, links, options, observer, of_keyframes ? &*of_keyframes : nullptr);
  observer.on_stage("whole map");
  const std::vector<LoopCluster> clusters = loop_clusters(hypotheses, map.map_from_keyframe, trusted_pieces(links), {});
  const VisibilityOptions& visibility = options.robust.search.visibility;
  const LoopSolution solution = close_loops(views, links, hypotheses, clusters, visibility, options.loop_closing,
                                            options.chain.threads, observer);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const int rank = solution.link_choice[i];
    map.link_choice[i] =
        rank == kCut ? kCut : static_cast<int>(ranked_hypothesis(chain.links[i], static_cast<std::size_t>(rank)));
  }
  const std::vector<PoseConstraint> loops = loop_constraints(clusters, solution.accepted);
  find_parts(chain, loops, options, map);
  std::vector<PoseConstraint> known = link_constraints(chain, map.link_choice);
  known.insert(known.end(), loops.begin(), loops.end());
  map.map_from_keyframe = refine_map(views, solution.map_from_node, known, options.robust.search, options.refinement,
                                     options.chain.threads, observer);
  for (const std::size_t k : solution.accepted) {
    if (is_closed(clusters[k], map.map_from_keyframe)) map.loops.push_back(closed_loop(chain, clusters[k]));
  }
  return map;
}

}  // namespace shapemap
