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

/// A scan that others are aligned to.
struct Keyframe {
  std::size_t scan_index = 0;
  std::size_t session = 0;  ///< the recording that it is from
  std::shared_ptr<const ScanView> view;
  std::optional<ExpectedPose> expected;  ///< see ScanTracker::expected()
  /// Of each sub-scan by itself where the position has several, else empty.
  std::vector<std::shared_ptr<const ScanView>> sweep_views;
};

/// A scan that a keyframe stands for: taken from nearly the same place.
struct AttachedScan {
  std::size_t scan_index = 0;
  std::size_t keyframe = 0;
  MatchCandidate pose;  ///< in the frame of the keyframe
};

/// What all scans of both sides say of a link that was in doubt: see verify_doubtful_edges().
struct VerifiedChoice {
  std::size_t candidate = 0;                   ///< the best
  double probability = 0.0;                    ///< that it is right
  std::size_t in_map = 0;                      ///< the hypothesis that the map had until then
  std::vector<EdgeSupport> support_by_others;  ///< of each hypothesis
  std::vector<double> parallel_support;        ///< of each hypothesis: see VerifiedEdge
};

/// What a keyframe may be to the one before it, and which of it the scans around choose.
struct OdometryEdge {
  std::vector<MatchCandidate> candidates;  ///< none: another log starts here, or nothing fits
  std::vector<std::vector<double>>
      transition_scores;    ///< [hypothesis][that of the next link]: how well the two go together
  std::size_t num_own = 0;  ///< so many, the first, are the best first; the rest is by way of scans further back
  double insufficient_view =
      0.0;                   ///< of the two scans; 0 where a motion was expected: the true place is then looked for
  bool is_complete = false;  ///< nothing more will be looked for until all is known
  Choice choice;
  std::optional<VerifiedChoice> verified;
  /// Keyframes between the two were retired, see cull_keyframes(): there is one hypothesis, which is that of the map
  /// and certain, and this is its covariance.
  std::optional<Eigen::Matrix3d> culled_covariance;
};

struct KeyframeGraph {
  std::vector<Keyframe> keyframes;
  std::vector<AttachedScan> attached;
  std::vector<OdometryEdge> edges;  ///< links[i] joins keyframe i to keyframe i + 1
};

/// Returns the index of the first keyframe whose scan is number `scan_index` or a later one.
std::size_t keyframe_of(const KeyframeGraph& graph, std::size_t scan_index);

/// As logarithm of odds against it, of a keyframe that is found there, seen from the one before it: by habit where
/// nothing was to be expected.
double surprise(const Keyframe& keyframe, const MotionPrior& prior, const Pose2& found);

/// What hypothesis number `k` of a link says. It is held at least as well as a motion is usually known before, best
/// where scans follow each other closely, whichever hypothesis: none must be taken for being held less, and a corridor
/// must not shrink because its scans slide.
PoseConstraint edge_constraint(const KeyframeGraph& graph, std::size_t edge, std::size_t k);

/// match_probability() of the place that the chain chose; 1 where nothing is asked any more, 0 where there is none.
double edge_probability(const OdometryEdge& edge);

/// That hypothesis number `k` of a link is right, by its two scans; `margin` is its score above the best other place.
double probability_by_two_scans(const OdometryEdge& edge, std::size_t k, double margin);

/// That the link is right, by all that is known but loops: what is stated in the end.
double stated_probability(const OdometryEdge& edge);

/// By the motions that are as good as certain, and that the scans hold in every direction.
MotionPrior motion_prior(const KeyframeGraph& graph);

/// OdometryEdge::bonus of links that may be anything to each other.
std::vector<std::vector<double>> no_transition_scores(const OdometryEdge& edge, const OdometryEdge& next);

/// Each link takes the hypothesis that goes together best with the links before and after it; its margin is that to the
/// best that is another place. Along a bare corridor, hypotheses that slide along it are none.
void choose_candidates(KeyframeGraph& graph);

}  // namespace shapemap
