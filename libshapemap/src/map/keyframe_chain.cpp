// SPDX-License-Identifier: GPL-3.0-or-later
#include "keyframe_chain.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace shapemap {
namespace {

/// A link that may be nothing is one choice as well.
std::size_t num_choices(const KeyframeLink& link) { return std::max<std::size_t>(link.hypotheses.size(), 1); }

/// Both what the scans tell and that the sensor cannot jump: along a bare corridor, only that.
Eigen::Matrix3d with_usual_motion(const Eigen::Matrix3d& covariance, bool is_expected) {
  const double usual_m = is_expected ? kUsualSurprise_m : kUsualSlip_m;
  const Eigen::Vector3d usual(usual_m, usual_m, is_expected ? kUsualSurprise_rad : kUsualSlip_rad);
  const Eigen::Matrix3d motion = usual.cwiseAbs2().asDiagonal();
  const Eigen::Matrix3d both = motion * (motion + covariance).inverse() * covariance;
  return 0.5 * (both + both.transpose());
}

}  // namespace

PoseConstraint link_constraint(const KeyframeChain& chain, std::size_t link, std::size_t k) {
  const KeyframeLink& of = chain.links[link];
  const PoseHypothesis& pose = of.hypotheses[k];
  if (of.settled_covariance) return {link, link + 1, pose.ref_from_query, *of.settled_covariance, 0.0};
  const bool is_expected = chain.keyframes[link + 1].expected.has_value();
  return {link, link + 1, pose.ref_from_query, with_usual_motion(pose_covariance(pose.fit), is_expected), 0.0};
}

double link_probability(const KeyframeLink& link, const ConfidenceOptions& options) {
  if (link.settled_covariance) return 1.0;
  return judged(link.hypotheses, link.choice.alternative, link.choice.margin, options).probability;
}

std::vector<std::vector<double>> no_bonus(const KeyframeLink& link, const KeyframeLink& next) {
  return {num_choices(link), std::vector<double>(num_choices(next), 0.0)};
}

void choose_hypotheses(KeyframeChain& chain) {
  ChoiceChain choices;
  for (const KeyframeLink& link : chain.links) {
    std::vector<double>& scores = choices.scores.emplace_back();
    for (const PoseHypothesis& pose : link.hypotheses) scores.push_back(pose.score);
    scores.resize(num_choices(link), 0.0);
    choices.bonus.push_back(link.bonus);
  }
  const std::vector<Choice> best = best_choices(choices, kFullMargin);
  for (std::size_t i = 0; i < chain.links.size(); ++i) chain.links[i].choice = best[i];
}

}  // namespace shapemap
