// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/inference/map_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "inference_numbers.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/inference/map_score.hpp"
#include "shapemap/matching/match_probability.hpp"

namespace shapemap {
namespace {

struct Neighbour {
  std::size_t a;
  std::size_t b;
  double apart;
};

/// Returns, for each node, the earlier nodes that most likely see the same. Half of them may be from the same stretch
/// of the trajectory.
std::vector<Neighbour> neighbours(const std::vector<Pose2>& poses, const RefinementOptions& options) {
  std::vector<std::vector<Neighbour>> near(poses.size());
  std::vector<std::vector<Neighbour>> far(poses.size());
  for (const auto& [a, b] : near_pairs(poses, options.within_m)) {
    if (b - a < kInference.map_score.least_apart) continue;
    const double apart = (poses[a].translation() - poses[b].translation()).norm() +
                         kInference.refinement.m_per_rad * angle_between(poses[a].theta_rad, poses[b].theta_rad);
    (b - a < kInference.agreement.same_stretch ? near : far)[b].push_back({a, b, apart});
  }
  std::vector<Neighbour> chosen;
  for (auto* groups : {&near, &far}) {
    for (std::vector<Neighbour>& group : *groups) {
      std::stable_sort(group.begin(), group.end(),
                       [](const Neighbour& one, const Neighbour& other) { return one.apart < other.apart; });
      const std::size_t count = std::min(group.size(), static_cast<std::size_t>(options.neighbours / 2));
      chosen.insert(chosen.end(), group.begin(), group.begin() + static_cast<std::ptrdiff_t>(count));
    }
  }
  return chosen;
}

}  // namespace

RefinedMap refine_map(const std::vector<std::shared_ptr<const ScanView>>& views, std::vector<Pose2> map_from_node,
                      const std::vector<PoseConstraint>& odometry, const MapRefinement& how,
                      const Execution& execution) {
  const RefinementOptions& options = how.refinement;
  const PoseTolerance most_off{options.most_off_m, options.most_off_rad};
  RefinedMap map;
  for (int round = 0; round < options.rounds && execution.observer.keep_going(); ++round) {
    const std::vector<Neighbour> pairs = neighbours(map_from_node, options);
    std::vector<std::optional<PoseConstraint>> found(pairs.size());
    parallel_for(pairs.size(), execution.threads, [&](std::size_t i) {
      const auto [a, b, unused] = pairs[i];
      const Pose2 expected = inverse(map_from_node[a]) * map_from_node[b];
      const MatchCandidate pose = refined_candidate(*views[a], *views[b], expected, how.search);
      const double agree = pose.visibility.agree / std::max(pose.visibility.total(), 1e-9);
      if (agree < options.least_agree || !agrees(expected, pose.ref_from_query, most_off)) return;
      found[i] = PoseConstraint{a, b, pose.ref_from_query, pose_covariance(pose.fit), kInference.refinement.loss};
    });
    map.neighbours.clear();
    for (const auto& constraint : found) {
      if (constraint) map.neighbours.push_back(*constraint);
    }
    std::vector<PoseConstraint> constraints = odometry;
    for (PoseConstraint& edge : constraints) edge.loss_scale = kInference.refinement.loss;
    constraints.insert(constraints.end(), map.neighbours.begin(), map.neighbours.end());
    map_from_node = solve_pose_graph(map_from_node, constraints).map_from_node;
  }
  map.map_from_node = std::move(map_from_node);
  return map;
}

}  // namespace shapemap
