// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/paper/correspondence.hpp"

/// Paper, sections II-D and III: from hypotheses of correspondences to one translation. The collinear filter and the
/// segment filter eliminate false correspondences; segment-wise translation chooses among what they leave.
namespace shapemap {

struct FilterOptions {
  double collinear_angle_rad = 10 * kDegree;
  double segment_gap_m = 0.30;
  double segment_distance_factor = 2.0;
  double segment_distance_slack_m = 0.20;
  int main_segments = 5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"collinear-angle-deg", "correspondences this close to along their surface are dropped [deg]", 0, 90,
                kDegree},
          self.collinear_angle_rad);
    visit(Field{"segment-gap-m", "a jump this long starts a new segment of correspondences [m]", 0, 100},
          self.segment_gap_m);
    visit(Field{"segment-distance-factor", "a segment may be this many times worse than the main one, plus", 0, 100},
          self.segment_distance_factor);
    visit(Field{"segment-distance-slack-m", "this much [m]", 0, 100}, self.segment_distance_slack_m);
    visit(Field{"main-segments", "best main segments, with translations of their own, that go on to the overlap", 1,
                1000},
          self.main_segments);
  }
};

/// Section II-D, "collinear filter": drops correspondences whose translation runs along the tangent of either point.
/// Slid along a wall, they say nothing. A translation of zero has no direction and stays.
Correspondences collinear_filter(const Correspondences& correspondences, const FilterOptions& options);

/// Runs of consecutive correspondences without a jump in either sequence.
using Segments = std::vector<Correspondences>;

/// Starts a new segment where a correspondence lies `segment_gap_m` or more from the one before it, in either scan, or
/// belongs to another target scan.
Segments cut_into_segments(const Correspondences& correspondences, const FilterOptions& options);

/// Section II-D, "segment filter": takes each segment as the main segment, translates by its mean and drops the
/// segments that are then much worse than it; the quality of the main segment is the number of correspondences left.
/// Returns the surviving segments of the best main segments, best first. The paper goes on with the best alone
/// (`main_segments = 1`); more of them let the scan overlap measure decide between translations that are
/// `segment_distance_slack_m` or more apart.
std::vector<Segments> segment_filter(const Segments& segments, const FilterOptions& options);

/// A translation of the turned query, and what supports it.
struct SegmentTranslation {
  Point2 target_from_query_m{0.0, 0.0};
  double mean_distance_m = 0.0;  ///< within the segment that gave the translation
  int num_correspondences = 0;   ///< point pairs within that distance; 0: there was no segment
  Correspondences kept;          ///< those pairs
};

/// Section III, "segment wise translation": returns, of the mean translations of the segments, the one that keeps most
/// point pairs within its own segment's mean distance.
SegmentTranslation segment_wise_translation(const Segments& segments);

}  // namespace shapemap
