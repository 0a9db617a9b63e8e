// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "motion/constant_velocity.hpp"
#include "shapemap/graph/edge_support.hpp"
#include "shapemap/graph/pose_graph.hpp"
#include "shapemap/matching/match_search.hpp"
#include "shapemap/matching/scan_matcher.hpp"
#include "viterbi.hpp"

namespace shapemap {

/// Where nothing is expected, a step is what the scans say, give or take this much.
inline constexpr double kUsualSlip_m = 0.5;
inline constexpr double kUsualSlip_rad = 180 * kDegree;

/// A scan that others are aligned to.
struct Keyframe {
  std::size_t position_index = 0;
  std::size_t session = 0;  ///< the recording that it is from
  std::shared_ptr<const ScanView> view;
  std::optional<ExpectedPose> expected;  ///< see KeyframeTracker::expected()
  /// Of each sub-scan by itself where the position has several, else empty.
  std::vector<std::shared_ptr<const ScanView>> sweep_views;
};

/// A scan that a keyframe stands for: taken from nearly the same place.
struct AttachedScan {
  std::size_t position_index = 0;
  std::size_t keyframe = 0;
  PoseHypothesis pose;  ///< in the frame of the keyframe
};

/// What all scans of both sides say of a link that was in doubt: see revise_doubtful_links().
struct RevisedChoice {
  std::size_t hypothesis = 0;           ///< the best
  double probability = 0.0;             ///< that it is right
  std::size_t in_map = 0;               ///< the hypothesis that the map had until then
  std::vector<Balance> said_by_others;  ///< of each hypothesis
  std::vector<double> vouched;          ///< of each hypothesis: see RevisedLink
};

/// What a keyframe may be to the one before it, and which of it the scans around choose.
struct KeyframeLink {
  std::vector<PoseHypothesis> hypotheses;  ///< none: another log starts here, or nothing fits
  std::vector<std::vector<double>> bonus;  ///< [hypothesis][that of the next link]: how well the two go together
  std::size_t num_own = 0;      ///< so many, the first, are the best first; the rest is by way of scans further back
  double view_shortfall = 0.0;  ///< of the two scans; 0 where a motion was expected: the true place is then looked for
  bool is_complete = false;     ///< nothing more will be looked for until all is known
  Choice choice;
  std::optional<RevisedChoice> revised;
  /// Keyframes between the two were retired, see retire_keyframes(): there is one hypothesis, which is that of the map
  /// and certain, and this is its covariance.
  std::optional<Eigen::Matrix3d> settled_covariance;
};

struct KeyframeChain {
  std::vector<Keyframe> keyframes;
  std::vector<AttachedScan> attached;
  std::vector<KeyframeLink> links;  ///< links[i] joins keyframe i to keyframe i + 1
};

/// As logarithm of odds against it, of a keyframe that is found there, seen from the one before it: by habit where
/// nothing was to be expected.
double surprise(const Keyframe& keyframe, const MotionHabit& habit, const Pose2& found);

/// What hypothesis number `k` of a link says. It is held at least as well as a motion is usually known before, best
/// where scans follow each other closely, whichever hypothesis: none must be taken for being held less, and a corridor
/// must not shrink because its scans slide.
PoseConstraint link_constraint(const KeyframeChain& chain, std::size_t link, std::size_t k);

/// match_probability() of the place that the chain chose; 1 where nothing is asked any more, 0 where there is none.
double link_probability(const KeyframeLink& link);

/// That hypothesis number `k` of a link is right, by its two scans; `margin` is its score above the best other place.
double probability_by_two_scans(const KeyframeLink& link, std::size_t k, double margin);

/// That the link is right, by all that is known but loops: what is stated in the end.
double stated_probability(const KeyframeLink& link);

/// By the motions that are as good as certain, and that the scans hold in every direction.
MotionHabit motion_habit(const KeyframeChain& chain);

/// KeyframeLink::bonus of links that may be anything to each other.
std::vector<std::vector<double>> no_bonus(const KeyframeLink& link, const KeyframeLink& next);

/// Each link takes the hypothesis that goes together best with the links before and after it; its margin is that to the
/// best that is another place. Along a bare corridor, hypotheses that slide along it are none.
void choose_hypotheses(KeyframeChain& chain);

}  // namespace shapemap
