// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "shapemap/core/numbers.hpp"
#include "shapemap/matching/match_search.hpp"

/// These functions give the probability and the covariance of a match.
namespace shapemap {

double log_odds_of(double probability);
double probability_of(double log_odds);

/// Returns the probability that `best` is right, for any pair of scans. `margin` is its score minus that of the best
/// candidate at another place.
double match_probability(const MatchCandidate& best, double margin);

/// Returns the probability that a match of two successive scans is right, from match_probability(), which allows for
/// scans of two different places, and insufficient_view().
double odometry_probability(double match_probability, double insufficient_view);

/// Returns how far the scan that sees less falls short of 0.45 of all directions (ScanView::seen_share). The less a
/// scan sees, the likelier the two share no surfaces that fix the pose, and no candidate is the true pose. The weight
/// of this number was fitted to lasers with a field of view of 100 degrees and more.
double insufficient_view(const ScanView& a, const ScanView& b);

/// This margin means that there is no candidate at another place.
inline constexpr double kFullMargin = 20.0;

/// Returns the margin of the first of distinct candidates, which are ordered best first.
double lead_of_first(const std::vector<MatchCandidate>& candidates);

/// The noise model of a point's distance from the line through its partner.
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

/// Returns the covariance of (x, y, theta), in metres and radians, of a fit. A direction that no line constrains gets a
/// deviation of metres.
Eigen::Matrix3d pose_covariance(const LineFit& fit, const LineNoise& noise = {});

/// Returns the standard deviation of the position in the direction that is constrained least.
double worst_deviation_m(const Eigen::Matrix3d& covariance);

/// Returns the standard deviation of the position in the direction that is constrained most, as across a corridor.
double best_deviation_m(const Eigen::Matrix3d& covariance);

}  // namespace shapemap
