// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimized_map.hpp"

#include <algorithm>
#include <cmath>

#include "inference_numbers.hpp"
#include "loops/loop_candidates.hpp"
#include "loops/loops_numbers.hpp"
#include "shapemap/inference/map_refinement.hpp"
#include "shapemap/inference/map_search.hpp"
#include "shapemap/loops/perceptual_aliasing.hpp"

namespace shapemap {
namespace {

/// Fills in the components of the map, and which edges loops constrain. An improbable edge that no loop holds is cut,
/// unless `improbable` says otherwise.
void find_parts(const KeyframeGraph& graph, const std::vector<PoseConstraint>& loops, Improbable improbable,
                const RobustOptions& options, OptimizedMap& map) {
  const std::size_t count = graph.keyframes.size();
  map.loop_constrained.assign(graph.edges.size(), false);
  std::vector<PoseConstraint> constraints = edge_constraints(graph, map.edge_choice);
  constraints.insert(constraints.end(), loops.begin(), loops.end());
  const std::vector<bool> lone = bridge_edges(count, constraints);
  std::size_t next = 0;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    if (map.edge_choice[i] == kCut) continue;
    const bool alone = lone[next++];
    map.loop_constrained[i] = !alone;
    if (!alone || improbable == Improbable::kStays) continue;
    if (stated_probability(graph.edges[i]) < options.front_end.split_below) map.edge_choice[i] = kCut;
  }
  constraints = edge_constraints(graph, map.edge_choice);
  constraints.insert(constraints.end(), loops.begin(), loops.end());
  map.component = connected_components(count, constraints);
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    if (map.edge_choice[i] == kCut) map.loop_constrained[i] = map.component[i] == map.component[i + 1];
  }
}

/// Returns, for each keyframe, the number of the stretch of trusted edges that it is in.
std::vector<std::size_t> trusted_submaps(const std::vector<Edge>& edges) {
  std::vector<std::size_t> submap(edges.size() + 1, 0);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    submap[i + 1] = submap[i] + (edges[i].exists() && edges[i].probability >= kInference.search.trusted ? 0 : 1);
  }
  return submap;
}

std::vector<PoseConstraint> loop_constraints(const std::vector<LoopCluster>& clusters,
                                             const std::vector<std::size_t>& accepted) {
  std::vector<PoseConstraint> constraints;
  for (const std::size_t k : accepted) {
    const std::vector<EdgeCandidate>& members = clusters[k].members;
    for (std::size_t m = 0; m < std::min(kInference.objective.members_kept, members.size()); ++m) {
      constraints.push_back(
          {members[m].a, members[m].b, members[m].a_from_b, members[m].covariance, kInference.agreement.match_loss});
    }
  }
  return constraints;
}

/// Says whether the map agrees with a loop. With robust losses, all other constraints outvote a wrong loop.
bool is_closed(const LoopCluster& cluster, const std::vector<Pose2>& map_from_keyframe) {
  const EdgeCandidate& best = cluster.members.front();
  return agrees(best.a_from_b, inverse(map_from_keyframe[best.a]) * map_from_keyframe[best.b],
                kInference.agreement.contradicts);
}

ClosedLoop closed_loop(const KeyframeGraph& graph, const LoopCluster& cluster) {
  const EdgeCandidate& best = cluster.members.front();
  return {graph.keyframes[best.a].scan_index, graph.keyframes[best.b].scan_index, best.a_from_b, cluster.strength};
}

}  // namespace

std::vector<PoseConstraint> edge_constraints(const KeyframeGraph& graph, const std::vector<int>& edge_choice) {
  std::vector<PoseConstraint> constraints;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    if (edge_choice[i] == kCut) continue;
    constraints.push_back(edge_constraint(graph, i, static_cast<std::size_t>(edge_choice[i])));
  }
  return constraints;
}

OptimizedMap map_of_odometry(const KeyframeGraph& graph, const RobustOptions& options) {
  OptimizedMap map;
  map.map_from_keyframe.resize(graph.keyframes.size());
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const OdometryEdge& edge = graph.edges[i];
    map.edge_choice.push_back(edge.candidates.empty() ? kCut : static_cast<int>(edge.choice.candidate));
    if (edge.candidates.empty()) continue;
    map.map_from_keyframe[i + 1] = map.map_from_keyframe[i] * edge.candidates[edge.choice.candidate].ref_from_query;
  }
  find_parts(graph, {}, Improbable::kIsCut, options, map);
  return map;
}

OptimizedMap optimized_map(const KeyframeGraph& graph, const std::vector<EdgeCandidate>& found, Improbable improbable,
                           const RobustOptions& options, const Execution& execution) {
  RunObserver& observer = execution.observer;
  observer.on_stage("whole map");
  OptimizedMap map = map_of_odometry(graph, options);
  const NodeViews views = views_of(graph);
  const std::vector<Edge> edges = edge_choices(graph);
  const std::vector<EdgeCandidate> candidates =
      without_aliases(found, edges, map.map_from_keyframe, options.map_search.doubt_below);
  const std::vector<LoopCluster> clusters =
      loop_clusters(candidates, map.map_from_keyframe, trusted_submaps(edges), kLoops.clusters);
  const VisibilityOptions& visibility = options.matcher.search.visibility;
  const MapSolution solution =
      search_map({views, edges, candidates, clusters}, visibility, options.map_search, execution);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const int rank = solution.edge_choice[i];
    map.edge_choice[i] =
        rank == kCut ? kCut : static_cast<int>(ranked_candidate(graph.edges[i], static_cast<std::size_t>(rank)));
  }
  const std::vector<PoseConstraint> loops = loop_constraints(clusters, solution.accepted);
  find_parts(graph, loops, improbable, options, map);
  map.constraints = edge_constraints(graph, map.edge_choice);
  map.constraints.insert(map.constraints.end(), loops.begin(), loops.end());
  RefinedMap refined = refine_map(views, solution.map_from_node, map.constraints,
                                  {options.matcher.search, options.refinement}, execution);
  map.map_from_keyframe = std::move(refined.map_from_node);
  map.constraints.insert(map.constraints.end(), refined.neighbours.begin(), refined.neighbours.end());
  std::vector<char> is_accepted(clusters.size(), 0);
  for (const std::size_t k : solution.accepted) is_accepted[k] = 1;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const bool is_closed_in_map = is_closed(clusters[k], map.map_from_keyframe);
    if (is_accepted[k] && is_closed_in_map) {
      map.loops.push_back(closed_loop(graph, clusters[k]));
    } else {
      const char* why = is_accepted[k]     ? "all others outvote it"
                        : is_closed_in_map ? "closing it gains too little"
                                           : "the map has its two places elsewhere";
      map.refused_loops.push_back({closed_loop(graph, clusters[k]), why});
    }
  }
  return map;
}

}  // namespace shapemap
