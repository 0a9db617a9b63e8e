// SPDX-License-Identifier: GPL-3.0-or-later
#include "keyframe_graph.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace shapemap {
namespace {

/// A link that may be nothing is one choice as well.
std::size_t num_choices(const OdometryEdge& link) { return std::max<std::size_t>(link.candidates.size(), 1); }

/// Both what the scans tell and that the sensor cannot jump: along a bare corridor, only that.
Eigen::Matrix3d with_usual_motion(const Eigen::Matrix3d& covariance, bool is_expected) {
  const double usual_m = is_expected ? kUsualSurprise_m : kUsualSlip_m;
  const Eigen::Vector3d usual(usual_m, usual_m, is_expected ? kUsualSurprise_rad : kUsualSlip_rad);
  const Eigen::Matrix3d motion = usual.cwiseAbs2().asDiagonal();
  const Eigen::Matrix3d both = motion * (motion + covariance).inverse() * covariance;
  return 0.5 * (both + both.transpose());
}

/// What the choice of a link leads by over all that is another place. Of places that were not found it is only known
/// that they are no better than the worst that was.
double margin_to_other_places(const KeyframeGraph& chain, std::size_t link) {
  const OdometryEdge& of = chain.edges[link];
  const Choice& choice = of.choice;
  if (of.candidates.size() < 2) return kFullMargin;
  const PoseConstraint chosen = edge_constraint(chain, link, choice.candidate);
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

double surprise(const Keyframe& keyframe, const MotionPrior& prior, const Pose2& found) {
  return keyframe.expected ? surprise(*keyframe.expected, found) : prior.surprise(found);
}

PoseConstraint edge_constraint(const KeyframeGraph& chain, std::size_t link, std::size_t k) {
  const OdometryEdge& of = chain.edges[link];
  const MatchCandidate& pose = of.candidates[k];
  if (of.culled_covariance) return {link, link + 1, pose.ref_from_query, *of.culled_covariance, 0.0};
  const bool is_expected = chain.keyframes[link + 1].expected.has_value();
  return {link, link + 1, pose.ref_from_query, with_usual_motion(pose_covariance(pose.fit), is_expected), 0.0};
}

double edge_probability(const OdometryEdge& link) {
  if (link.culled_covariance) return 1.0;
  if (link.candidates.empty()) return 0.0;
  return match_probability(link.candidates[link.choice.candidate], link.choice.margin);
}

double probability_by_two_scans(const OdometryEdge& link, std::size_t k, double margin) {
  return odometry_probability(match_probability(link.candidates[k], margin), link.insufficient_view);
}

double stated_probability(const OdometryEdge& link) {
  if (link.verified) return link.verified->probability;
  if (link.culled_covariance || link.candidates.empty()) return edge_probability(link);
  return probability_by_two_scans(link, link.choice.candidate, link.choice.margin);
}

MotionPrior motion_prior(const KeyframeGraph& chain) {
  constexpr double kCertain = 0.98;
  constexpr double kHeld_m = 0.2;
  std::vector<Pose2> motions;
  for (const OdometryEdge& link : chain.edges) {
    if (link.culled_covariance || stated_probability(link) < kCertain) continue;
    const MatchCandidate& chosen = link.candidates[link.choice.candidate];
    if (worst_deviation_m(pose_covariance(chosen.fit)) < kHeld_m) motions.push_back(chosen.ref_from_query);
  }
  return MotionPrior(motions);
}

std::vector<std::vector<double>> no_transition_scores(const OdometryEdge& link, const OdometryEdge& next) {
  return {num_choices(link), std::vector<double>(num_choices(next), 0.0)};
}

void choose_candidates(KeyframeGraph& chain) {
  ViterbiChain choices;
  for (const OdometryEdge& link : chain.edges) {
    std::vector<double>& scores = choices.scores.emplace_back();
    for (const MatchCandidate& pose : link.candidates) scores.push_back(pose.score);
    scores.resize(num_choices(link), 0.0);
    choices.transition_scores.push_back(link.transition_scores);
  }
  const std::vector<Choice> best = viterbi(choices, kFullMargin);
  for (std::size_t i = 0; i < chain.edges.size(); ++i) {
    chain.edges[i].choice = best[i];
    chain.edges[i].choice.margin = margin_to_other_places(chain, i);
  }
}

}  // namespace shapemap
