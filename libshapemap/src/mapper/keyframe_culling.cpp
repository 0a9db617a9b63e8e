// SPDX-License-Identifier: GPL-3.0-or-later
#include "keyframe_culling.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "localization/localization_numbers.hpp"
#include "mapper_numbers.hpp"
#include "shapemap/graph/relative_covariance.hpp"
#include "shapemap/inference/map_search.hpp"

namespace shapemap {
namespace {

Pose2 between(const OptimizedMap& map, std::size_t a, std::size_t b) {
  return inverse(map.map_from_keyframe[a]) * map.map_from_keyframe[b];
}

/// Computes the graph, the map and the loop candidates that are left when keyframes are culled.
class KeyframeCulling {
 public:
  KeyframeCulling(const std::vector<std::optional<ReplacementKeyframe>>& redundant, const MappingOptions& options,
                  OptimizedMap& map, KeyframeGraph& graph, LoopCandidates& known)
      : redundant_(redundant), options_(options), map_(map), graph_(graph), known_(known), number_(redundant.size()) {
    for (std::size_t i = 0; i < redundant.size(); ++i) {
      number_[i] = kept_.size();
      if (!redundant[i]) kept_.push_back(i);
    }
  }

  void run() {
    renew_loops();
    attach_scans();
    renew_graph();
    renew_map();
  }

 private:
  bool is_kept(std::size_t keyframe) const { return !redundant_[keyframe]; }
  std::size_t kept_for(std::size_t keyframe) const {
    return is_kept(keyframe) ? keyframe : redundant_[keyframe]->keyframe;
  }

  /// Keeps the candidates between kept keyframes. The constraints of culled keyframes become candidates between their
  /// replacements, at the poses of the map.
  void renew_loops() {
    std::vector<EdgeCandidate> candidates;
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    for (const EdgeCandidate& loop : known_.candidates) {
      if (!is_kept(loop.a) || !is_kept(loop.b)) continue;
      candidates.push_back(loop);
      candidates.back().a = number_[loop.a];
      candidates.back().b = number_[loop.b];
      if (agrees(loop.a_from_b, between(map_, loop.a, loop.b), kLocalization.redundancy.as_in_map)) {
        pairs.insert({candidates.back().a, candidates.back().b});
      }
    }
    for (const PoseConstraint& constraint : map_.constraints) {
      const Pose2 as_in_map = between(map_, constraint.a, constraint.b);
      if (!agrees(constraint.a_from_b, as_in_map, kLocalization.redundancy.as_in_map)) continue;
      const auto [a, b] = std::minmax({kept_for(constraint.a), kept_for(constraint.b)});
      if (number_[b] - number_[a] < static_cast<std::size_t>(options_.robust.loop_detection.shortest_loop)) continue;
      if (!pairs.insert({number_[a], number_[b]}).second) continue;
      candidates.push_back(
          {number_[a], number_[b], between(map_, a, b), constraint.covariance, kMapper.updates.settled_log_odds});
    }
    known_.candidates = std::move(candidates);
    known_.num_searched = number_of_kept_before(known_.num_searched);
    known_.num_bridged = number_of_kept_before(known_.num_bridged);
  }

  std::size_t number_of_kept_before(std::size_t end) const {
    return end < number_.size() ? number_[end] : kept_.size();
  }

  void attach_scans() {
    for (AttachedScan& scan : graph_.attached) {
      const auto& replacement = redundant_[scan.keyframe];
      if (replacement) scan.pose.ref_from_query = replacement->pose.ref_from_query * scan.pose.ref_from_query;
      scan.keyframe = number_[kept_for(scan.keyframe)];
    }
    for (std::size_t i = 0; i < redundant_.size(); ++i) {
      if (is_kept(i)) continue;
      const ReplacementKeyframe& replacement = *redundant_[i];
      graph_.attached.push_back({graph_.keyframes[i].scan_index, number_[replacement.keyframe], replacement.pose});
    }
  }

  void renew_graph() {
    const RelativeCovariance covariance(map_.map_from_keyframe, map_.constraints);
    KeyframeGraph renewed;
    renewed.attached = std::move(graph_.attached);
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      renewed.keyframes.push_back(std::move(graph_.keyframes[kept_[k]]));
      if (k == 0) continue;
      const std::size_t before = kept_[k - 1];
      const bool are_neighbours = before + 1 == kept_[k];
      renewed.edges.push_back(are_neighbours ? std::move(graph_.edges[before])
                                             : culled_edge(before, kept_[k], covariance));
    }
    for (std::size_t i = 0; i + 1 < renewed.edges.size(); ++i) {
      OdometryEdge& edge = renewed.edges[i];
      if (kept_[i + 2] != kept_[i] + 2) edge.transition_scores = no_transition_scores(edge, renewed.edges[i + 1]);
    }
    graph_ = std::move(renewed);
    choose_candidates(graph_);
  }

  /// Returns the edge in place of those to culled keyframes between `a` and `b`.
  OdometryEdge culled_edge(std::size_t a, std::size_t b, const RelativeCovariance& covariance) const {
    OdometryEdge edge;
    MatchCandidate pose;
    pose.ref_from_query = between(map_, a, b);
    edge.candidates = {pose};
    edge.culled_covariance = covariance.between(a, b);
    return edge;
  }

  void renew_map() {
    OptimizedMap renewed;
    renewed.constraints = renewed_constraints();
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      renewed.map_from_keyframe.push_back(map_.map_from_keyframe[kept_[k]]);
      renewed.component.push_back(number_[kept_for(map_.component[kept_[k]])]);
      if (k == 0) continue;
      const std::size_t before = kept_[k - 1];
      const bool are_neighbours = before + 1 == kept_[k];
      renewed.edge_choice.push_back(are_neighbours ? map_.edge_choice[before] : 0);
      renewed.loop_constrained.push_back(!are_neighbours || map_.loop_constrained[before]);
      if (!are_neighbours) renewed.constraints.push_back(edge_constraint(graph_, k - 1, 0));
    }
    renewed.loops = std::move(map_.loops);
    map_ = std::move(renewed);
  }

  /// Keeps the constraints between kept keyframes. Of those of culled keyframes, one is left for each pair of
  /// replacements that has no constraint yet.
  std::vector<PoseConstraint> renewed_constraints() const {
    std::vector<PoseConstraint> constraints;
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    for (const bool of_kept : {true, false}) {
      for (PoseConstraint constraint : map_.constraints) {
        if ((is_kept(constraint.a) && is_kept(constraint.b)) != of_kept) continue;
        const auto [a, b] = std::minmax({kept_for(constraint.a), kept_for(constraint.b)});
        const bool is_new = pairs.insert({a, b}).second;
        if (!of_kept) {
          if (a == b || !is_new) continue;
          constraint.a_from_b = between(map_, a, b);
        }
        constraint.a = number_[a];
        constraint.b = number_[b];
        constraints.push_back(constraint);
      }
    }
    return constraints;
  }

  const std::vector<std::optional<ReplacementKeyframe>>& redundant_;
  const MappingOptions& options_;
  OptimizedMap& map_;
  KeyframeGraph& graph_;
  LoopCandidates& known_;
  std::vector<std::size_t> kept_;    ///< the keyframes that stay
  std::vector<std::size_t> number_;  ///< for each keyframe, the number of kept ones before it
};

}  // namespace

void cull_keyframes(const std::vector<std::optional<ReplacementKeyframe>>& redundant, const MappingOptions& options,
                    OptimizedMap& map, KeyframeGraph& graph, LoopCandidates& known) {
  KeyframeCulling(redundant, options, map, graph, known).run();
}

}  // namespace shapemap
