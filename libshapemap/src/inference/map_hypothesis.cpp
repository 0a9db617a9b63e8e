// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_hypothesis.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "inference_numbers.hpp"
#include "loops/loops_numbers.hpp"
#include "shapemap/matching/match_probability.hpp"

namespace shapemap {
namespace {

/// Says whether two loops join the same two stretches of the trajectory. Such loops are right or wrong together.
bool are_of_same_stretches(const PoseConstraint& one, const PoseConstraint& other) {
  const auto apart = [](std::size_t a, std::size_t b) { return std::max(a, b) - std::min(a, b); };
  const std::size_t near = kInference.agreement.same_stretch;
  return apart(one.a, other.a) <= near && apart(one.b, other.b) <= near;
}

/// Returns the best members of a cluster, at most one for each node.
std::vector<PoseConstraint> constraints_of(const LoopCluster& cluster) {
  std::vector<PoseConstraint> result;
  std::set<std::size_t> of_a;
  std::set<std::size_t> of_b;
  for (const EdgeCandidate& member : cluster.members) {
    if (result.size() == kInference.objective.members_used) break;
    if (of_a.count(member.a) != 0 || of_b.count(member.b) != 0) continue;
    of_a.insert(member.a);
    of_b.insert(member.b);
    result.push_back({member.a, member.b, member.a_from_b, member.covariance, kInference.agreement.match_loss});
  }
  return result;
}

}  // namespace

MapObjective::MapObjective(const GraphEvidence& evidence, const VisibilityOptions& visibility,
                           const MapSearchOptions& options, int threads)
    : edges_(evidence.edges),
      clusters_(evidence.clusters),
      options_(options),
      score_(evidence.views, visibility, threads),
      num_nodes_(evidence.views.size()),
      usual_(step_statistics(sure_steps(evidence.edges))) {
  for (const LoopCluster& cluster : clusters_) loop_constraints_.push_back(constraints_of(cluster));
  conflicts_ = conflicting_loops(clusters_);
}

MapHypothesis MapObjective::undecided(std::vector<Pose2> map_from_node) const {
  const double apart_m = kInference.search.components_apart_m;
  MapHypothesis choice;
  choice.edge_choice.assign(edges_.size(), kCut);
  choice.accepted.assign(clusters_.size(), 0);
  choice.refused_off.assign(clusters_.size(), Pose2{apart_m, apart_m, 0.0});
  choice.map_from_node = std::move(map_from_node);
  return choice;
}

MapHypothesis MapObjective::chain_alone() {
  MapHypothesis choice = undecided(std::vector<Pose2>(num_nodes_));
  double next_component_m = 0.0;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (edges_[i].exists()) {
      choice.edge_choice[i] = 0;
      choice.map_from_node[i + 1] = choice.map_from_node[i] * edges_[i].candidates.front().a_from_b;
    } else {
      next_component_m += kInference.search.components_apart_m;
      choice.map_from_node[i + 1] = {next_component_m, 0.0, 0.0};
    }
  }
  rate(choice);
  return choice;
}

MapHypothesis MapObjective::of_map(std::vector<Pose2> map_from_node) {
  MapHypothesis choice = undecided(std::move(map_from_node));
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Pose2 taken = inverse(choice.map_from_node[i]) * choice.map_from_node[i + 1];
    for (std::size_t k = 0; k < edges_[i].candidates.size() && choice.edge_choice[i] == kCut; ++k) {
      const bool is_taken = agrees(edges_[i].candidates[k].a_from_b, taken, kInference.agreement.agrees);
      if (is_taken) choice.edge_choice[i] = static_cast<int>(k);
    }
  }
  for (std::size_t k = 0; k < clusters_.size(); ++k) {
    const bool counts = clusters_[k].strength >= kInference.objective.least_strength;
    choice.accepted[k] = counts && is_within(off(choice, k), kInference.agreement.agrees) ? 1 : 0;
  }
  for (std::size_t i = 0; i < edges_.size(); ++i) {  // candidates of the odometry join what nothing else does
    if (choice.edge_choice[i] != kCut || !edges_[i].exists()) continue;
    const std::vector<std::size_t> part = connected_components(num_nodes_, constraints(choice));
    if (part[i] != part[i + 1]) choice.edge_choice[i] = 0;
  }
  solve(choice);
  rate(choice);
  return choice;
}

std::vector<PoseConstraint> MapObjective::constraints(const MapHypothesis& choice) const {
  std::vector<PoseConstraint> all;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (choice.edge_choice[i] == kCut) continue;
    const EdgeCandidate& edge = edges_[i].candidates[static_cast<std::size_t>(choice.edge_choice[i])];
    all.push_back({i, i + 1, edge.a_from_b, edge.covariance, 0.0});
  }
  for (std::size_t k = 0; k < clusters_.size(); ++k) {
    if (choice.accepted[k]) all.insert(all.end(), loop_constraints_[k].begin(), loop_constraints_[k].end());
  }
  return all;
}

void MapObjective::solve(MapHypothesis& choice) const {
  PoseGraphSolution solution =
      solve_pose_graph(choice.map_from_node, constraints(choice), kInference.objective.iterations);
  choice.map_from_node = std::move(solution.map_from_node);
  choice.chi_square = solution.chi_square;
}

double MapObjective::worth(std::size_t cluster) const {
  return std::min(clusters_[cluster].strength, options_.trust_cap);
}

double MapObjective::worth_in(const MapHypothesis& choice, std::size_t cluster) const {
  double strongest = 0.0;
  for (const ConflictingLoop& rival : conflicts_[cluster]) {
    if (rival.strength <= strongest) continue;
    if (!is_within(off(choice, rival.cluster), kInference.agreement.contradicts)) strongest = rival.strength;
  }
  return std::clamp(clusters_[cluster].strength - strongest, 0.0, options_.trust_cap);
}

std::vector<std::size_t> MapObjective::rings(const MapHypothesis& choice) const {
  std::vector<PoseConstraint> held = constraints(choice);
  const std::vector<bool> lone = bridge_edges(num_nodes_, held);
  std::size_t c = 0;
  held.erase(std::remove_if(held.begin(), held.end(), [&](const PoseConstraint&) { return lone[c++]; }), held.end());
  return connected_components(num_nodes_, held);
}

/// Returns the cost of candidates that are not the best, of cut edges, and of unusual steps and turns.
double MapObjective::cost_of_edges(const MapHypothesis& choice) const {
  const ObjectiveNumbers& numbers = kInference.objective;
  double cost = 0.0;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& edge = edges_[i];
    if (!edge.exists() || edge.probability >= options_.doubt_below) continue;
    if (choice.edge_choice[i] == kCut) {
      const double p = std::clamp(std::max(edge.probability, edge.any_probability), numbers.least_probability,
                                  1.0 - 1e-6);  // the log odds stay finite
      cost += std::max(0.0, log_odds_of(p) + kLoops.members.prior);
    } else {
      const auto taken = static_cast<std::size_t>(choice.edge_choice[i]);
      cost +=
          edge.candidates.front().score - edge.candidates[taken].score + (taken == 0 ? 0.0 : numbers.against_odometry);
    }
    const Pose2& from = choice.map_from_node[i];
    const Pose2& to = choice.map_from_node[i + 1];
    const double steps = (from.translation() - to.translation()).norm() / usual_.step_m;
    const double turns = angle_between(from.theta_rad, to.theta_rad) / usual_.turn_rad;
    for (const double times : {steps, turns}) {
      cost += options_.step_penalty * std::clamp(times - 1.0, 0.0, numbers.most_unusual);
    }
  }
  return cost;
}

void MapObjective::rate(MapHypothesis& choice) {
  choice.value = kInference.map_score_weights.weight * score_.of(choice.map_from_node, rings(choice)) -
                 0.5 * choice.chi_square - cost_of_edges(choice) + worth_of_loops(choice);
}

double MapObjective::worth_of_loops(const MapHypothesis& choice) const {
  std::vector<std::size_t> closed;
  for (std::size_t k = 0; k < clusters_.size(); ++k) {
    if (choice.accepted[k]) closed.push_back(k);
  }
  std::vector<PoseConstraint> alike;
  for (std::size_t i = 0; i < closed.size(); ++i) {
    for (std::size_t j = i + 1; j < closed.size(); ++j) {
      if (!are_of_same_stretches(best_member(closed[i]), best_member(closed[j]))) continue;
      alike.push_back({i, j, {}, Eigen::Matrix3d::Identity(), 0.0});
    }
  }
  const std::vector<std::size_t> story = connected_components(closed.size(), alike);
  std::vector<double> sums(closed.size(), 0.0);
  for (std::size_t i = 0; i < closed.size(); ++i) sums[story[i]] += worth_in(choice, closed[i]);
  double worth = 0.0;
  for (const double sum : sums) {
    if (sum > 0.0) worth += options_.trust_cap * (1.0 - std::exp(-sum / options_.trust_cap));
  }
  return worth;
}

Pose2 MapObjective::off(const MapHypothesis& choice, std::size_t cluster) const {
  const PoseConstraint& best = best_member(cluster);
  return inverse(best.a_from_b) * (inverse(choice.map_from_node[best.a]) * choice.map_from_node[best.b]);
}

}  // namespace shapemap
