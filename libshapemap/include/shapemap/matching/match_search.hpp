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

/// A pose that the query scan may have, and how well the two scans then go together.
struct MatchCandidate {
  Pose2 ref_from_query;
  double score = 0.0;  ///< visibility_score(), less for a poor fit
  Visibility visibility;
  LineFit fit;
};

/// Distinct poses that `query` may have in the frame of `reference`, any heading and offset, best first. Empty when one
/// of them has no points.
std::vector<MatchCandidate> find_candidates(const ScanView& reference, const ScanView& query,
                                            const MatchSearchOptions& options);

/// The same for a scan that most likely follows the other as `habit` says, with more effort: what is unusual scores
/// less, and is less likely to be looked into.
std::vector<MatchCandidate> find_usual_candidates(const ScanView& reference, const ScanView& query,
                                                  const MatchSearchOptions& options, const MotionPrior& prior);

/// Refines a pose and judges it.
MatchCandidate refined_candidate(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                                 const MatchSearchOptions& options);

/// Judges a pose as it is.
MatchCandidate candidate_at(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                            const MatchSearchOptions& options);

/// The best of `hypotheses`, one for each place; at most `count`.
std::vector<MatchCandidate> best_distinct(std::vector<MatchCandidate> candidates, int count);

/// Adds `pose` unless its place is known: a place twice would be its own rival, and leave no margin between the two.
void add_if_new(const MatchCandidate& pose, std::vector<MatchCandidate>& distinct);

}  // namespace shapemap
