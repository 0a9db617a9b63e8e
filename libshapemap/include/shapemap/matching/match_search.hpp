// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/matching/point_to_line.hpp"
#include "shapemap/matching/translation_voting.hpp"
#include "shapemap/matching/visibility.hpp"
#include "shapemap/motion/motion_prior.hpp"

namespace shapemap {

struct CandidateOptions {
  int rotation_peaks = 8;
  double all_rotations_below = 0.0;
  double all_rotations_step_rad = 5 * kDegree;
  int shape_segments = 2;
  int refined = 20;
  int kept = 5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"rotation-peaks", "rotations that bring most tangents together and are tried", 1, 360},
          self.rotation_peaks);
    visit(Field{"all-rotations-below", "when no pose scores as much, all rotations are tried", -100, 100},
          self.all_rotations_below);
    visit(Field{"all-rotations-step-deg", "step between them [deg]", 0.5, 180, kDegree}, self.all_rotations_step_rad);
    visit(Field{"shape-segments", "longest segments of the LCS that put up a translation", 0, 1000},
          self.shape_segments);
    visit(Field{"refined-candidates", "poses that are refined", 1, 1000}.formerly("refined-hypotheses"), self.refined);
    visit(Field{"kept-candidates", "distinct poses that are kept, best first", 1, 100}.formerly("kept-hypotheses"),
          self.kept);
  }
};

struct MatchSearchOptions {
  VotingOptions voting;
  CandidateOptions candidates;
  VisibilityOptions visibility;
  PointToLineOptions line;
};

/// A candidate is a pose that the query scan may have, with the evidence of the two scans at this pose.
struct MatchCandidate {
  Pose2 ref_from_query;
  double score = 0.0;  ///< visibility_score(), minus a penalty for the residuals of the fit
  Visibility visibility;
  LineFit fit;
};

/// Returns distinct poses that `query` may have in the frame of `reference`, with any heading and offset, best first.
/// There are none when one of the scans has no points.
std::vector<MatchCandidate> find_candidates(const ScanView& reference, const ScanView& query,
                                            const MatchSearchOptions& options);

/// Does the same with more effort for a scan whose motion since the other has the density `prior`: unlikely motions
/// score less, and are less likely to be refined.
std::vector<MatchCandidate> find_usual_candidates(const ScanView& reference, const ScanView& query,
                                                  const MatchSearchOptions& options, const MotionPrior& prior);

/// Refines a pose by fit_to_lines(), and returns its evidence.
MatchCandidate refined_candidate(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                                 const MatchSearchOptions& options);

/// Returns the evidence of a pose as it is.
MatchCandidate candidate_at(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                            const MatchSearchOptions& options);

/// Returns at most `count` of `candidates`, best first, and only the best at each place.
std::vector<MatchCandidate> best_distinct(std::vector<MatchCandidate> candidates, int count);

/// Adds `pose` unless `distinct` has its place, since a place that is there twice would leave no margin to the best
/// other place.
void add_if_new(const MatchCandidate& pose, std::vector<MatchCandidate>& distinct);

}  // namespace shapemap
