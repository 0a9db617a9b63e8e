// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/core/numbers.hpp"
#include "shapemap/matching/match_probability.hpp"

/// The numbers of how two scans are matched, and of how probable it is that the match is right.
namespace shapemap {

struct CandidateNumbers {
  PoseTolerance same_place{0.20, 5 * kDegree};
  double coarse_slack = 2.0;
  std::size_t coarse_stride = 2;
  int all_rotations_fewer_peaks = 4;
  int usual_effort = 2;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"same_place", "candidates that agree to this are one after refinement",
                      "set by hand: a place twice would be its own rival; the evaluation of pairs calls a pose right "
                      "within the same limits"},
          self.same_place);
    visit(NumberField{"coarse_slack", "the distances of the visibility are so many times wider before refinement",
                      "set by hand: poses are then off by up to a cell of the votes"},
          self.coarse_slack);
    visit(NumberField{"coarse_stride", "before refinement, one point in so many is looked at",
                      "set by hand, for speed: neighbouring points tell much the same"},
          self.coarse_stride);
    visit(NumberField{"all_rotations_fewer_peaks",
                      "where all rotations are tried, each puts up so many times fewer translations",
                      "set by hand, for speed: there are then about ten times as many rotations"},
          self.all_rotations_fewer_peaks);
    visit(NumberField{"usual_effort", "so many times as many poses are tried where the usual motion is looked for",
                      "set by hand: only doubtful edges are searched so"},
          self.usual_effort);
  }
};

struct ScoreWeights {
  double agree = 6.5;
  double cross_agree = 1.0;
  double crossed = -2.7;
  double residual_per_m = -56.0;
  double agree_offset = 0.05;
  double cross_agree_offset = 0.05;
  double crossed_offset = 0.02;
  double unclear_share = 0.25;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    const char* const fitted =
        "candidates of pairs of scans 1, 2, 3 and 5 apart of real logs with reference poses: conditional logit by "
        "scripts/evaluate.py fit-scores, rounded";
    const char* const finite = "set by hand before the fit of the weights, so that the logarithm stays finite";
    visit(NumberField{"agree", "weight of the logarithm of the share of points that agree", fitted}, self.agree);
    visit(NumberField{"cross_agree", "weight of the same across the direction that most surface runs in", fitted},
          self.cross_agree);
    visit(NumberField{"crossed", "weight of the logarithm of the share that beams would have to cross", fitted},
          self.crossed);
    visit(NumberField{"residual_per_m", "weight of the root mean square distance from the lines [1/m]", fitted},
          self.residual_per_m);
    visit(NumberField{"agree_offset", "is added to the share that agrees", finite}, self.agree_offset);
    visit(NumberField{"cross_agree_offset", "is added to the share that agrees across", finite},
          self.cross_agree_offset);
    visit(NumberField{"crossed_offset", "is added to the share that is crossed", finite}, self.crossed_offset);
    visit(NumberField{"unclear_share", "an unclear point counts as so much of one that agrees",
                      "set by hand before the fit of the weights: it lies near a surface, but not like it"},
          self.unclear_share);
  }
};

struct MatchProbabilityWeights {
  double constant = -0.34;
  double per_margin = 0.61;
  double per_log_margin = 0.28;
  double per_score = 0.58;
  double per_log_agree = 1.07;
  double agree_offset = 0.02;
  double least_margin = 0.05;
  double full_margin = kFullMargin;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    const char* const fitted =
        "the best candidate of pairs of scans 1, 2, 3 and 5 apart of real logs with reference poses and, with "
        "threefold weight, of pairs of different buildings: logistic regression by scripts/evaluate.py fit-scores, "
        "rounded";
    const char* const finite = "set by hand before the fit of the weights, so that the logarithm stays finite";
    visit(NumberField{"constant", "log odds that a match is right, before all else", fitted}, self.constant);
    visit(NumberField{"per_margin", "log odds for the margin to the second distinct candidate", fitted},
          self.per_margin);
    visit(NumberField{"per_log_margin", "log odds for the logarithm of that margin", fitted}, self.per_log_margin);
    visit(NumberField{"per_score", "log odds for the score", fitted}, self.per_score);
    visit(NumberField{"per_log_agree", "log odds for the logarithm of the share of points that agree", fitted},
          self.per_log_agree);
    visit(NumberField{"agree_offset", "is added to the share that agrees", finite}, self.agree_offset);
    visit(NumberField{"least_margin", "a smaller margin counts as this", finite}, self.least_margin);
    visit(NumberField{"full_margin", "the margin that stands for no other place, and the largest that counts",
                      "set by hand: a margin so large is certain in any case"},
          self.full_margin);
  }
};

struct OdometryProbabilityWeights {
  double constant = 3.0;
  double per_log_odds = 0.48;
  double per_insufficient_view = -12.0;
  double enough_view = 0.45;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    const char* const fitted =
        "edges that no loop holds, of thinned orebro, belgioioso, aces and csail and of simulated arenas 0-79: "
        "logistic regression by scripts/evaluate.py fit-edges";
    visit(NumberField{"constant", "log odds that a match of neighbours is right, before all else", fitted},
          self.constant);
    visit(NumberField{"per_log_odds", "log odds for those of the match by itself", fitted}, self.per_log_odds);
    visit(
        NumberField{"per_insufficient_view", "log odds for the insufficient view of the two scans",
                    "edges that no loop holds, of hard scenes 20-49, all else as it is: scripts/evaluate.py fit-edges "
                    "--shortfall-alone"},
        self.per_insufficient_view);
    visit(NumberField{"enough_view", "the share of all directions that is enough for one scan to see",
                      "half a circle, with some slack for beams that do not return"},
          self.enough_view);
  }
};

struct CovarianceNumbers {
  double unknown_m = 10.0;
  double least_lever_m = 0.1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"unknown_m", "the standard deviation in a direction that nothing holds",
                      "as far as a position can be off and still be near"},
          self.unknown_m);
    visit(NumberField{"least_lever_m", "points are taken to lie at least this far from the robot",
                      "set by hand, so that a turn can be compared with a shift at all"},
          self.least_lever_m);
  }
};

struct ReplacementNumbers {
  double least_agree = 0.55;
  double most_crossed = 0.08;
  double most_deviation_m = 0.10;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    const char* const reason = "set by hand: one of the two scans then replaces the other for good";
    visit(NumberField{"least_agree", "two scans show the same where more of their points agree", reason},
          self.least_agree);
    visit(NumberField{"most_crossed", "and a smaller share of them is crossed", reason}, self.most_crossed);
    visit(NumberField{"most_deviation_m", "and the pose is held better than this in every direction", reason},
          self.most_deviation_m);
  }
};

struct LineFitNumbers {
  PoseTolerance still{1e-3, 1e-3};
  double trusted_share_of_gate = 0.3;
  int least_partners = 3;
  double gate_shrinks = 0.8;
  double gate_shrinks_when_still = 0.5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"still", "an iteration that moves the pose by less has converged",
                      "a smaller step changes nothing that matters"},
          self.still);
    visit(NumberField{"trusted_share_of_gate", "partners farther apart than this share of the gate count less and less",
                      "set by hand: the gate must be wide at first, and lets wrong partners in"},
          self.trusted_share_of_gate);
    visit(NumberField{"least_partners", "fewer partners hold no pose", "a pose has three degrees of freedom"},
          self.least_partners);
    visit(NumberField{"gate_shrinks", "what is left of the gate after an iteration", "set by hand"}, self.gate_shrinks);
    visit(NumberField{"gate_shrinks_when_still", "and after one that has converged",
                      "set by hand, for speed: nothing more is to be had from the present gate"},
          self.gate_shrinks_when_still);
  }
};

struct VotingNumbers {
  double shift_by_reach = 0.75;
  double least_shift_m = 2.0;
  double most_shift_m = 8.0;
  std::size_t cells_per_peak = 9;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"shift_by_reach", "the longest motion that is looked for, as a share of how far the scans see",
                      "set by hand: most of what two scans share is nearer than they see, and farther motions leave "
                      "little to compare"},
          self.shift_by_reach);
    visit(NumberField{"least_shift_m", "but at least this far", "set by hand: a small room must not hide a motion"},
          self.least_shift_m);
    visit(NumberField{"most_shift_m", "and at most this far", "set by hand: farther motions leave little to compare"},
          self.most_shift_m);
    visit(NumberField{"cells_per_peak", "so many of the best cells are sorted for each translation that is wanted",
                      "a peak hides the eight cells beside it"},
          self.cells_per_peak);
  }
};

struct VisibilityNumbers {
  double footprints = 1.5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"footprints", "so many footprints of a beam may a point lie beside it and still agree",
                      "set by hand: a surface is sampled only every footprint"},
          self.footprints);
  }
};

struct MatchingNumbers {
  CandidateNumbers candidates;
  ScoreWeights score;
  MatchProbabilityWeights match_probability;
  OdometryProbabilityWeights odometry_probability;
  LineNoise line_noise;
  CovarianceNumbers covariance;
  ReplacementNumbers replacement;
  LineFitNumbers line_fit;
  VotingNumbers voting;
  VisibilityNumbers visibility;

  /// Calls `visit(name, title, group)` for each group; `group` is a struct with `fields`.
  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("candidates", "The search for candidates of a match", self.candidates);
    visit("score", "The score of a candidate", self.score);
    visit("match_probability", "The probability of a match", self.match_probability);
    visit("odometry_probability", "The probability of a match of neighbours", self.odometry_probability);
    visit("line_noise", "What a point tells of a pose by its line", self.line_noise);
    visit("covariance", "The covariance of a match", self.covariance);
    visit("replacement", "Whether one scan can replace another", self.replacement);
    visit("line_fit", "The refinement to lines", self.line_fit);
    visit("voting", "The votes for translations", self.voting);
    visit("visibility", "What one scan sees of another", self.visibility);
  }
};

inline constexpr MatchingNumbers kMatching{};

}  // namespace shapemap
