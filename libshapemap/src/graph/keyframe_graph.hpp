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

/// A scan that others are matched to.
struct Keyframe {
  std::size_t scan_index = 0;
  std::size_t session = 0;  ///< number of the recording that it is from
  std::shared_ptr<const ScanView> view;
  std::optional<ExpectedPose> expected;  ///< see ScanTracker::expected()
  /// The views of the single sweeps; empty if the scan has only one.
  std::vector<std::shared_ptr<const ScanView>> sweep_views;
};

/// A scan that a keyframe can replace, since it was taken from nearly the same place.
struct AttachedScan {
  std::size_t scan_index = 0;
  std::size_t keyframe = 0;
  MatchCandidate pose;  ///< in the frame of the keyframe
};

/// The verdict of all scans of both submaps on a doubtful edge, see verify_doubtful_edges().
struct VerifiedChoice {
  std::size_t candidate = 0;                   ///< index of the best candidate
  double probability = 0.0;                    ///< probability that it is right
  std::size_t in_map = 0;                      ///< index of the candidate that the map had before
  std::vector<EdgeSupport> support_by_others;  ///< of each candidate
  std::vector<double> parallel_support;        ///< of each candidate, see VerifiedEdge
};

/// The edge between two consecutive keyframes, with its candidates and the one that the Viterbi algorithm chooses.
struct OdometryEdge {
  std::vector<MatchCandidate> candidates;  ///< empty if another session starts here, or nothing fits
  /// The scores of three-scan consistency: [candidate][candidate of the next edge].
  std::vector<std::vector<double>> transition_scores;
  std::size_t num_own = 0;  ///< number of its own candidates, best first; multi-reference candidates follow
  /// insufficient_view() of the two scans; 0 where a pose was expected, since the search then includes the true one.
  double insufficient_view = 0.0;
  bool is_complete = false;  ///< whether no more candidates are searched until all scans are known
  Choice choice;
  std::optional<VerifiedChoice> verified;
  /// The covariance of the only candidate, if keyframes between the two were culled by cull_keyframes(). That candidate
  /// has the relative pose of the map, and is certain.
  std::optional<Eigen::Matrix3d> culled_covariance;
};

struct KeyframeGraph {
  std::vector<Keyframe> keyframes;
  std::vector<AttachedScan> attached;
  std::vector<OdometryEdge> edges;  ///< edges[i] joins keyframe i to keyframe i + 1
};

/// Returns the index of the first keyframe whose scan is number `scan_index` or a later one.
std::size_t keyframe_of(const KeyframeGraph& graph, std::size_t scan_index);

/// Returns the log odds against a keyframe that is found at the pose `found` in the frame of the one before it. The
/// motion prior gives them where no pose was expected.
double surprise(const Keyframe& keyframe, const MotionPrior& prior, const Pose2& found);

/// Returns the constraint of candidate number `k` of an edge. Its covariance is limited by the usual motion, in the
/// same way for all candidates: a weak constraint must not make a candidate cheap, and a corridor must not shrink
/// because its scans slide along it.
PoseConstraint edge_constraint(const KeyframeGraph& graph, std::size_t edge, std::size_t k);

/// Returns match_probability() of the chosen candidate; 1 for a culled edge, and 0 for an edge without candidates.
double edge_probability(const OdometryEdge& edge);

/// Returns the probability that candidate number `k` of an edge is right, by its two scans. `margin` is its score minus
/// that of the best candidate at another place.
double probability_by_two_scans(const OdometryEdge& edge, std::size_t k, double margin);

/// Returns the probability that the edge is right, by all evidence but loops. The result of the map states this one.
double stated_probability(const OdometryEdge& edge);

/// Learns the motion prior from the edges that are as good as certain and that scans constrain in every direction.
MotionPrior motion_prior(const KeyframeGraph& graph);

/// Returns OdometryEdge::transition_scores of zero, which prefer no pair of candidates.
std::vector<std::vector<double>> no_transition_scores(const OdometryEdge& edge, const OdometryEdge& next);

/// Chooses the best sequence of candidates by viterbi(). The margin of an edge is the one to the best candidate at
/// another place; candidates that only slide along a bare corridor are at the same place.
void choose_candidates(KeyframeGraph& graph);

}  // namespace shapemap
