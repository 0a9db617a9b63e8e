// SPDX-License-Identifier: GPL-3.0-or-later
#include "doubtful_edges.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "graph/keyframe_match_cache.hpp"
#include "inference_numbers.hpp"
#include "loops/loop_candidates.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/inference/edge_verification.hpp"
#include "shapemap/inference/map_refinement.hpp"
#include "shapemap/inference/map_search.hpp"
#include "shapemap/matching/scan_matcher.hpp"

namespace shapemap {
namespace {

Eigen::Matrix3d loop_covariance() {
  const VerificationNumbers& numbers = kInference.verification;
  return Eigen::Vector3d(numbers.loop_variance_m2, numbers.loop_variance_m2, numbers.loop_variance_rad2).asDiagonal();
}

class DoubtfulEdges {
 public:
  DoubtfulEdges(const RobustOptions& options, const Execution& execution, KeyframeGraph& graph, OptimizedMap& map,
                MatchCache* store)
      : options_(options), execution_(execution), graph_(graph), map_(map), store_(store), views_(views_of(graph)) {}

  bool run() {
    poses_ = map_.map_from_keyframe;
    prior_ = motion_prior(graph_);
    find();
    if (doubts_.empty()) return false;
    const double least = options_.front_end.split_below;
    for (const bool thoroughly : {false, true}) {
      for (Doubt& doubt : doubts_) add_candidates(doubt, thoroughly);
      settle(thoroughly ? least : std::max(least, options_.edge_verification.clear_above));
      cut_those(/*all=*/thoroughly);
    }
    drop_contradicted_loops();
    if (!changed_) return false;
    map_.map_from_keyframe = poses_;
    std::vector<PoseConstraint> joined = edge_constraints(graph_, map_.edge_choice);
    const std::vector<PoseConstraint> closed = loops([](const ClosedLoop&) { return true; });
    joined.insert(joined.end(), closed.begin(), closed.end());
    part(joined);
    refine(joined);
    return true;
  }

 private:
  struct Doubt {
    Edge of_map;
    std::size_t in_map;                   ///< index among the candidates of the odometry edge
    std::vector<std::size_t> candidates;  ///< of each candidate in `of_map`: the same for it
  };

  /// Joins submaps at the edges that are certain by their present candidates. The other edges stay in doubt.
  void settle(double least_probability) {
    std::vector<Edge> doubtful;
    for (const Doubt& doubt : doubts_) doubtful.push_back(doubt.of_map);
    VerifiedMap verified = verify_edges(views_, {poses_, submap_}, doubtful,
                                        {options_.matcher.search.visibility, least_probability}, execution_);
    poses_ = std::move(verified.map_from_node);
    submap_ = std::move(verified.submap_of_node);
    std::vector<Doubt> rest;
    for (std::size_t d = 0; d < doubts_.size(); ++d) {
      const VerifiedEdge& edge = verified.edges[d];
      const std::size_t candidate = doubts_[d].candidates[edge.candidate];
      note(doubts_[d], edge);
      if (edge.joins) {
        take(doubts_[d].of_map.a, static_cast<int>(candidate));
      } else {
        rest.push_back(std::move(doubts_[d]));
      }
    }
    doubts_ = std::move(rest);
  }

  /// Cuts all doubtful edges, or those that contradict what joined their two submaps.
  void cut_those(bool all) {
    std::vector<Doubt> rest;
    for (Doubt& doubt : doubts_) {
      const std::size_t edge = doubt.of_map.a;
      if (!all && submap_[edge] != submap_[edge + 1]) {
        rest.push_back(std::move(doubt));
        continue;
      }
      map_.edge_choice[edge] = kCut;
      changed_ = true;
    }
    doubts_ = std::move(rest);
  }

  /// Records the verdict. An edge that was not verified, because the observer asked to stop, stays as probable as
  /// before.
  void note(const Doubt& doubt, const VerifiedEdge& edge) {
    std::optional<VerifiedChoice>& verified = graph_.edges[doubt.of_map.a].verified;
    verified.reset();
    if (edge.support_by_others.empty()) return;
    verified = VerifiedChoice{doubt.candidates[edge.candidate], edge.probability, doubt.in_map,
                              by_candidate(doubt, edge.support_by_others), by_candidate(doubt, edge.parallel_support)};
  }

  /// Brings values from the order of a doubtful edge, in which the candidate of the map comes first, to that of its
  /// edge.
  template <class What>
  static std::vector<What> by_candidate(const Doubt& doubt, const std::vector<What>& by_candidate) {
    std::vector<What> in_order(by_candidate.size());
    for (std::size_t c = 0; c < by_candidate.size(); ++c) in_order[doubt.candidates[c]] = by_candidate[c];
    return in_order;
  }

  /// Finds the doubtful edges, cut or not, that join submaps which neither sure edges nor sure loops join.
  void find() {
    std::vector<PoseConstraint> sure = loops([&](const ClosedLoop& loop) { return is_sure(loop); });
    std::vector<std::size_t> doubtful;
    for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
      if (is_doubtful(i)) {
        doubtful.push_back(i);
      } else if (map_.edge_choice[i] != kCut) {
        sure.push_back({i, i + 1, {}, Eigen::Matrix3d::Identity(), 0.0});
      }
    }
    submap_ = connected_components(views_.size(), sure);
    for (const std::size_t i : doubtful) {
      if (submap_[i] == submap_[i + 1]) continue;
      doubts_.push_back({edge_to_next(i, graph_.edges[i].insufficient_view), candidate_in_map(i), {}});
    }
  }

  bool is_sure(const ClosedLoop& loop) const {
    return loop.strength >= kInference.search.joining_strength ||
           !looks_all_round(*views_[keyframe_of(graph_, loop.a)]) ||
           !looks_all_round(*views_[keyframe_of(graph_, loop.b)]);
  }

  /// An edge that loops have cut is as doubtful as an improbable one, because the loops are doubtful, too.
  bool is_doubtful(std::size_t i) const {
    if (map_.component[i] != map_.component[i + 1] || graph_.edges[i].candidates.empty()) return false;
    const double chance = map_.edge_choice[i] == kCut ? 0.0 : stated_probability(graph_.edges[i]);
    return chance < std::max(options_.edge_verification.doubt_below, options_.front_end.split_below);
  }

  template <class Which>
  std::vector<PoseConstraint> loops(const Which& which) const {
    std::vector<PoseConstraint> constraints;
    for (const ClosedLoop& loop : map_.loops) {
      if (!which(loop)) continue;
      constraints.push_back(
          {keyframe_of(graph_, loop.a), keyframe_of(graph_, loop.b), loop.a_from_b, loop_covariance(), 0.0});
    }
    return constraints;
  }

  /// Opens the loops whose submaps were joined at another relative pose, or not at all.
  void drop_contradicted_loops() {
    const auto is_contradicted = [&](const ClosedLoop& loop) {
      const std::size_t a = keyframe_of(graph_, loop.a);
      const std::size_t b = keyframe_of(graph_, loop.b);
      return submap_[a] != submap_[b] ||
             !agrees(loop.a_from_b, inverse(poses_[a]) * poses_[b], kInference.agreement.contradicts);
    };
    const auto end = std::remove_if(map_.loops.begin(), map_.loops.end(), is_contradicted);
    changed_ = changed_ || end != map_.loops.end();
    map_.loops.erase(end, map_.loops.end());
  }

  void add_candidates(Doubt& doubt, bool thoroughly) {
    const std::size_t i = doubt.of_map.a;
    OdometryEdge& edge = graph_.edges[i];
    if (thoroughly) {
      search_again(i);
    } else if (edge_probability(edge) < options_.loop_detection.bridge_below) {
      add_bridges(i);
    }
    doubt.candidates = {doubt.in_map};
    doubt.of_map.candidates = {candidate(i, doubt.in_map, in_map(i))};
    for (std::size_t k = 0; k < edge.candidates.size(); ++k) {
      if (k == doubt.in_map) continue;
      doubt.candidates.push_back(k);
      doubt.of_map.candidates.push_back(candidate(i, k, edge.candidates[k].ref_from_query));
    }
  }

  EdgeCandidate candidate(std::size_t i, std::size_t k, const Pose2& a_from_b) const {
    const MatchCandidate& candidate = graph_.edges[i].candidates[k];
    return {i,
            i + 1,
            a_from_b,
            edge_constraint(graph_, i, k).covariance,
            candidate.score,
            best_deviation_m(pose_covariance(candidate.fit))};
  }

  /// Where loops have cut an edge, the pose of the map is added, as it may be none of the edge's candidates.
  std::size_t candidate_in_map(std::size_t i) {
    if (map_.edge_choice[i] != kCut) return static_cast<std::size_t>(map_.edge_choice[i]);
    std::vector<MatchCandidate>& known = graph_.edges[i].candidates;
    const Pose2 pose = in_map(i);
    add(i, refined_candidate(*views_[i], *views_[i + 1], pose, options_.matcher.search));
    const auto off = [&](const MatchCandidate& candidate) {
      return (candidate.ref_from_query.translation() - pose.translation()).norm() +
             angle_between(candidate.ref_from_query.theta_rad, pose.theta_rad);
    };
    const auto nearest = std::min_element(known.begin(), known.end(),
                                          [&](const auto& one, const auto& other) { return off(one) < off(other); });
    return static_cast<std::size_t>(nearest - known.begin());
  }

  Pose2 in_map(std::size_t i) const { return inverse(map_.map_from_keyframe[i]) * map_.map_from_keyframe[i + 1]; }

  /// Adds what scans before and after an edge say of each other, carried to the edge by the poses of the map.
  void add_bridges(std::size_t i) {
    const std::vector<Pose2>& poses = map_.map_from_keyframe;
    for (const EdgeCandidate& bridge :
         cross_edge_matches(views_, {i}, {options_.matcher.search, options_.loop_detection, execution_, store_})) {
      const Pose2 a_from_b =
          inverse(poses[i]) * (poses[bridge.a] * bridge.a_from_b * inverse(poses[bridge.b])) * poses[i + 1];
      if (a_from_b.translation().norm() > max_shift_m(*views_[i], *views_[i + 1], options_.matcher.search.voting)) {
        continue;
      }
      add(i, refined_candidate(*views_[i], *views_[i + 1], a_from_b, options_.matcher.search));
    }
  }

  /// The few edges that are left can have much more effort than the front end has for each edge.
  void search_again(std::size_t i) {
    MatchSearchOptions search = options_.matcher.search;
    for (int* effort : {&search.voting.peaks, &search.candidates.rotation_peaks, &search.candidates.refined,
                        &search.candidates.kept}) {
      *effort *= kInference.verification.more_effort;
    }
    for (const MatchCandidate& pose : find_candidates(*views_[i], *views_[i + 1], search)) add(i, pose);
  }

  /// An unusual motion scores less, as in the front end.
  void add(std::size_t i, MatchCandidate pose) {
    pose.score -= surprise(graph_.keyframes[i + 1], prior_, pose.ref_from_query);
    add_if_new(pose, graph_.edges[i].candidates);
  }

  void take(std::size_t edge, int candidate) {
    if (map_.edge_choice[edge] == candidate) return;
    map_.edge_choice[edge] = candidate;
    changed_ = true;
  }

  /// Moves components that are no longer joined apart, so that they do not overlap.
  void part(const std::vector<PoseConstraint>& joined) {
    map_.component = connected_components(views_.size(), joined);
    for (std::size_t n = 0; n < views_.size(); ++n) {
      if (map_.component[n] > 0)
        map_.map_from_keyframe[n].x_m += kInference.search.components_apart_m * static_cast<double>(map_.component[n]);
    }
    const std::vector<bool> lone = bridge_edges(views_.size(), joined);
    std::size_t next = 0;
    for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
      const bool is_cut = map_.edge_choice[i] == kCut;
      map_.loop_constrained[i] = is_cut ? map_.component[i] == map_.component[i + 1] : !lone[next++];
    }
  }

  void refine(const std::vector<PoseConstraint>& known) {
    map_.map_from_keyframe =
        refine_map(views_, map_.map_from_keyframe, known, {options_.matcher.search, options_.refinement}, execution_)
            .map_from_node;
  }

  const RobustOptions& options_;
  Execution execution_;
  KeyframeGraph& graph_;
  OptimizedMap& map_;
  MatchCache* store_;
  NodeViews views_;
  std::vector<Doubt> doubts_;
  MotionPrior prior_;
  std::vector<Pose2> poses_;         ///< of the nodes, in submaps as far as they are joined
  std::vector<std::size_t> submap_;  ///< of each node
  bool changed_ = false;
};

}  // namespace

bool verify_doubtful_edges(const RobustOptions& options, const Execution& execution, MatchCache* store,
                           KeyframeGraph& graph, OptimizedMap& map) {
  if (options.edge_verification.doubt_below <= 0.0) return false;
  std::optional<KeyframeMatchCache> of_keyframes;
  if (store) of_keyframes.emplace(graph, *store);
  try {
    return DoubtfulEdges(options, execution, graph, map, of_keyframes ? &*of_keyframes : nullptr).run();
  } catch (const Interrupted&) {
    return false;
  }
}

}  // namespace shapemap
