// SPDX-License-Identifier: GPL-3.0-or-later
#include "keyframe_graph.hpp"

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

/// What the choice of a link leads by over all that is another place. Of places that were not found it is only known
/// that they are no better than the worst that was.
double margin_to_other_places(const KeyframeChain& chain, std::size_t link) {
  const KeyframeLink& of = chain.links[link];
  const Choice& choice = of.choice;
  if (of.hypotheses.size() < 2) return kFullMargin;
  const PoseConstraint chosen = link_constraint(chain, link, choice.alternative);
  double to_other = kFullMargin;
  double to_worst = 0.0;
  for (std::size_t k = 0; k < of.hypotheses.size(); ++k) {
    if (k < of.num_own) to_worst = std::max(to_worst, choice.behind[k]);
    if (k != choice.alternative && !is_same_place(chosen, of.hypotheses[k].ref_from_query)) {
      to_other = std::min(to_other, choice.behind[k]);
    }
  }
  return to_worst > 0.0 ? std::min(to_other, to_worst) : to_other;
}

}  // namespace

double surprise(const Keyframe& keyframe, const MotionHabit& habit, const Pose2& found) {
  return keyframe.expected ? surprise(*keyframe.expected, found) : habit.surprise(found);
}

PoseConstraint link_constraint(const KeyframeChain& chain, std::size_t link, std::size_t k) {
  const KeyframeLink& of = chain.links[link];
  const PoseHypothesis& pose = of.hypotheses[k];
  if (of.settled_covariance) return {link, link + 1, pose.ref_from_query, *of.settled_covariance, 0.0};
  const bool is_expected = chain.keyframes[link + 1].expected.has_value();
  return {link, link + 1, pose.ref_from_query, with_usual_motion(pose_covariance(pose.fit), is_expected), 0.0};
}

double link_probability(const KeyframeLink& link) {
  if (link.settled_covariance) return 1.0;
  if (link.hypotheses.empty()) return 0.0;
  return match_probability(link.hypotheses[link.choice.alternative], link.choice.margin);
}

double probability_by_two_scans(const KeyframeLink& link, std::size_t k, double margin) {
  return probability_of_neighbours(match_probability(link.hypotheses[k], margin), link.view_shortfall);
}

double stated_probability(const KeyframeLink& link) {
  if (link.revised) return link.revised->probability;
  if (link.settled_covariance || link.hypotheses.empty()) return link_probability(link);
  return probability_by_two_scans(link, link.choice.alternative, link.choice.margin);
}

MotionHabit motion_habit(const KeyframeChain& chain) {
  constexpr double kCertain = 0.98;
  constexpr double kHeld_m = 0.2;
  std::vector<Pose2> motions;
  for (const KeyframeLink& link : chain.links) {
    if (link.settled_covariance || stated_probability(link) < kCertain) continue;
    const PoseHypothesis& chosen = link.hypotheses[link.choice.alternative];
    if (worst_deviation_m(pose_covariance(chosen.fit)) < kHeld_m) motions.push_back(chosen.ref_from_query);
  }
  return MotionHabit(motions);
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
  for (std::size_t i = 0; i < chain.links.size(); ++i) {
    chain.links[i].choice = best[i];
    chain.links[i].choice.margin = margin_to_other_places(chain, i);
  }
}

}  // namespace shapemap
