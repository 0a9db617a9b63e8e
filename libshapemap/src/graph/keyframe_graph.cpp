// SPDX-License-Identifier: GPL-3.0-or-later
#include "keyframe_graph.hpp"
#include "graph_numbers.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace shapemap {
namespace {

/// Returns at least 1, since an edge without candidates still is one state of the Viterbi algorithm.
std::size_t num_choices(const OdometryEdge& edge) { return std::max<std::size_t>(edge.candidates.size(), 1); }

/// Combines the covariance of the match with that of the usual motion, because the sensor cannot jump: along a bare
/// corridor, only the usual motion constrains the pose.
Eigen::Matrix3d with_usual_motion(const Eigen::Matrix3d& covariance, bool is_expected) {
  const StepNumbers& steps = kGraph.steps;
  const double usual_m = is_expected ? kUsualSurprise_m : steps.usual_slip_m;
  const Eigen::Vector3d usual(usual_m, usual_m, is_expected ? kUsualSurprise_rad : steps.usual_slip_rad);
  const Eigen::Matrix3d motion = usual.cwiseAbs2().asDiagonal();
  const Eigen::Matrix3d both = motion * (motion + covariance).inverse() * covariance;
  return 0.5 * (both + both.transpose());
}

/// Returns the margin of the chosen candidate of an edge over all candidates at other places. A place that the search
/// did not find can be as good as its worst candidate, so the margin is at most the one over that.
double margin_to_other_places(const KeyframeGraph& graph, std::size_t edge) {
  const OdometryEdge& of = graph.edges[edge];
  const Choice& choice = of.choice;
  if (of.candidates.size() < 2) return kFullMargin;
  const PoseConstraint chosen = edge_constraint(graph, edge, choice.candidate);
  double to_other = kFullMargin;
  double to_worst = 0.0;
  for (std::size_t k = 0; k < of.candidates.size(); ++k) {
    if (k < of.num_own) to_worst = std::max(to_worst, choice.behind[k]);
    if (k != choice.candidate && !is_same_place(chosen, of.candidates[k].ref_from_query)) {
      to_other = std::min(to_other, choice.behind[k]);
    }
  }
  return to_worst > 0.0 ? std::min(to_other, to_worst) : to_other;
}

}  // namespace

std::size_t keyframe_of(const KeyframeGraph& graph, std::size_t scan_index) {
  const auto found =
      std::lower_bound(graph.keyframes.begin(), graph.keyframes.end(), scan_index,
                       [](const Keyframe& keyframe, std::size_t scan) { return keyframe.scan_index < scan; });
  return static_cast<std::size_t>(found - graph.keyframes.begin());
}

double surprise(const Keyframe& keyframe, const MotionPrior& prior, const Pose2& found) {
  return keyframe.expected ? surprise(*keyframe.expected, found) : prior.surprise(found);
}

PoseConstraint edge_constraint(const KeyframeGraph& graph, std::size_t edge, std::size_t k) {
  const OdometryEdge& of = graph.edges[edge];
  const MatchCandidate& pose = of.candidates[k];
  if (of.culled_covariance) return {edge, edge + 1, pose.ref_from_query, *of.culled_covariance, 0.0};
  const bool is_expected = graph.keyframes[edge + 1].expected.has_value();
  return {edge, edge + 1, pose.ref_from_query, with_usual_motion(pose_covariance(pose.fit), is_expected), 0.0};
}

double edge_probability(const OdometryEdge& edge) {
  if (edge.culled_covariance) return 1.0;
  if (edge.candidates.empty()) return 0.0;
  return match_probability(edge.candidates[edge.choice.candidate], edge.choice.margin);
}

double probability_by_two_scans(const OdometryEdge& edge, std::size_t k, double margin) {
  return odometry_probability(match_probability(edge.candidates[k], margin), edge.insufficient_view);
}

double stated_probability(const OdometryEdge& edge) {
  if (edge.verified) return edge.verified->probability;
  if (edge.culled_covariance || edge.candidates.empty()) return edge_probability(edge);
  return probability_by_two_scans(edge, edge.choice.candidate, edge.choice.margin);
}

MotionPrior motion_prior(const KeyframeGraph& graph) {
  std::vector<Pose2> motions;
  for (const OdometryEdge& edge : graph.edges) {
    if (edge.culled_covariance || stated_probability(edge) < kGraph.steps.certain) continue;
    const MatchCandidate& chosen = edge.candidates[edge.choice.candidate];
    if (worst_deviation_m(pose_covariance(chosen.fit)) < kGraph.steps.held_m) motions.push_back(chosen.ref_from_query);
  }
  return MotionPrior(motions);
}

std::vector<std::vector<double>> no_transition_scores(const OdometryEdge& edge, const OdometryEdge& next) {
  return {num_choices(edge), std::vector<double>(num_choices(next), 0.0)};
}

void choose_candidates(KeyframeGraph& graph) {
  ViterbiChain choices;
  for (const OdometryEdge& edge : graph.edges) {
    std::vector<double>& scores = choices.scores.emplace_back();
    for (const MatchCandidate& pose : edge.candidates) scores.push_back(pose.score);
    scores.resize(num_choices(edge), 0.0);
    choices.transition_scores.push_back(edge.transition_scores);
  }
  const std::vector<Choice> best = viterbi(choices, kFullMargin);
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    graph.edges[i].choice = best[i];
    graph.edges[i].choice.margin = margin_to_other_places(graph, i);
  }
}

}  // namespace shapemap
