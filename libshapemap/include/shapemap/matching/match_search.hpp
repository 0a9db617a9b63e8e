// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/matching/point_to_line.hpp"
#include "shapemap/matching/translation_voting.hpp"
#include "shapemap/matching/visibility.hpp"
#include "shapemap/motion/motion_prior.hpp"

namespace shapemap {

struct HypothesisOptions {
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
    visit(Field{"refined-hypotheses", "poses that are refined", 1, 1000}, self.refined);
    visit(Field{"kept-hypotheses", "distinct poses that are kept, best first", 1, 100}, self.kept);
  }
};

struct HypothesisSearchOptions {
  VotingOptions voting;
  HypothesisOptions hypotheses;
  VisibilityOptions visibility;
  PointToLineOptions line;
};

/// A pose that the query scan may have, and how well the two scans then go together.
struct PoseHypothesis {
  Pose2 ref_from_query;
  double score = 0.0;  ///< visibility_score(), less for a poor fit
  Visibility visibility;
  LineFit fit;
};

/// Distinct poses that `query` may have in the frame of `reference`, any heading and offset, best first. Empty when one
/// of them has no points.
std::vector<PoseHypothesis> pose_hypotheses(const ScanView& reference, const ScanView& query,
                                            const HypothesisSearchOptions& options);

/// The same for a scan that most likely follows the other as `habit` says, with more effort: what is unusual scores
/// less, and is less likely to be looked into.
std::vector<PoseHypothesis> usual_hypotheses(const ScanView& reference, const ScanView& query,
                                             const HypothesisSearchOptions& options, const MotionHabit& habit);

/// Refines a pose and judges it.
PoseHypothesis refined_hypothesis(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                                  const HypothesisSearchOptions& options);

/// Judges a pose as it is.
PoseHypothesis hypothesis_at(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                             const HypothesisSearchOptions& options);

/// The best of `hypotheses`, one for each place; at most `count`.
std::vector<PoseHypothesis> best_distinct(std::vector<PoseHypothesis> hypotheses, int count);

/// Adds `pose` unless its place is known: a place twice would be its own rival, and leave no margin between the two.
void add_if_new(const PoseHypothesis& pose, std::vector<PoseHypothesis>& distinct);

}  // namespace shapemap
