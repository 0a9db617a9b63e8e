// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "shapemap/core/numbers.hpp"
#include "shapemap/matching/match_search.hpp"

/// What an alignment is worth.
namespace shapemap {

double log_odds_of(double probability);
double probability_of(double log_odds);

/// Probability that `best` is right. `margin` is its score above that of the best other place.
double match_probability(const MatchCandidate& best, double margin);

/// The same of two scans that follow each other, by what match_probability() says: it allows for scans of two different
/// places, which neighbours are not. See insufficient_view().
double odometry_probability(double match_probability, double insufficient_view);

/// How far the one of two scans that sees less falls short of 0.45 of all directions (ScanView::seen_share). The less
/// each sees, the likelier the two share nothing that tells where they are, and the true place is none of those that
/// are found. What that is worth is known of lasers with 100 degrees of view and more.
double insufficient_view(const ScanView& a, const ScanView& b);

/// The margin that stands for "there is no other place".
inline constexpr double kFullMargin = 20.0;

/// The margin of the first of distinct hypotheses, best first.
double lead_of_first(const std::vector<MatchCandidate>& candidates);

/// What a point tells of a pose by its line.
struct LineNoise {
  double residual_m = 0.12;
  double tangent = 0.10;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(NumberField{"residual_m",
                      "spread of a point about its line, larger than it is: neighbouring points err alike, which makes "
                      "many count as few",
                      "errors on simulated arenas, which agree with the covariance in the median"},
          self.residual_m);
    visit(NumberField{"tangent", "what a point seems to tell about sliding along its own line, and is noise",
                      "set by hand: tangents are only known to a few degrees"},
          self.tangent);
  }
};

/// Covariance of (x, y, theta) from the lines that hold the pose; a direction that none holds gets metres.
Eigen::Matrix3d pose_covariance(const LineFit& fit, const LineNoise& noise = {});

/// Standard deviation in the direction in which a position is held worst.
double worst_deviation_m(const Eigen::Matrix3d& covariance);

/// And in which it is held best: along a corridor, that across it.
double best_deviation_m(const Eigen::Matrix3d& covariance);

}  // namespace shapemap
