// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/core/options.hpp"
#include "shapemap/matching/match_probability.hpp"
#include "shapemap/matching/match_search.hpp"
#include "shapemap/matching/scan_match.hpp"

/// Two scans are matched with any heading and offset between them, and the match has a probability and a covariance.
namespace shapemap {

struct ConfidenceOptions {
  double sure_probability = 0.95;
  double min_agree = 0.03;
  double max_deviation_m = 0.50;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"sure-probability", "an alignment less probable than this is called ambiguous", 0, 1},
          self.sure_probability);
    visit(Field{"min-agree", "one in which a smaller share of the points agrees is refused", 0, 1}, self.min_agree);
    visit(Field{"max-deviation-m", "one whose position is held worse than this is called degenerate [m]", 0.01, 10},
          self.max_deviation_m);
  }
};

struct MatcherOptions {
  ViewOptions view;
  MatchSearchOptions search;
  ConfidenceOptions confidence;
};

/// Finds the pose of `query` in the frame of `reference` from the two scans alone. It never throws for scans that do
/// not match: see ScanMatch::status.
ScanMatch match_scans(const ScanView& reference, const ScanView& query, const MatcherOptions& options);

/// Returns a candidate as it is reported.
RankedPose ranked_pose(const MatchCandidate& pose);

/// Returns the match that takes candidate number `chosen`; `candidates` may have any order. `margin` is its score minus
/// that of the best other place. A given `probability` replaces that of the two scans alone.
ScanMatch judged(const std::vector<MatchCandidate>& candidates, std::size_t chosen, double margin,
                 const ConfidenceOptions& options, std::optional<double> probability = {});

}  // namespace shapemap
