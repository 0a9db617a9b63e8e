// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/match/filters.hpp"

namespace shapemap {

Segments cut_into_segments(const Correspondences& correspondences, const FilterOptions& options) {
  Segments segments;
  for (const Correspondence& c : correspondences) {
    const bool continues = !segments.empty() && segments.back().back().target_scan == c.target_scan &&
                           (segments.back().back().query_m - c.query_m).norm() < options.segment_gap_m &&
                           (segments.back().back().target_m - c.target_m).norm() < options.segment_gap_m;
    if (!continues) segments.emplace_back();
    segments.back().push_back(c);
  }
  return segments;
}

Segments segment_filter(const Segments& segments, const FilterOptions& options) {
  std::size_t best_quality = 0;
  std::vector<std::size_t> best;
  for (const Correspondences& main : segments) {
    const Correspondence* first = main.data();
    const Point2 translation_m = mean_translation_m(first, first + main.size());
    const double main_distance_m = mean_distance_m(first, first + main.size(), translation_m);
    const double limit_m = options.segment_distance_factor * main_distance_m + options.segment_distance_slack_m;
    std::size_t quality = 0;
    std::vector<std::size_t> kept;
    for (std::size_t s = 0; s < segments.size(); ++s) {
      const Correspondence* other = segments[s].data();
      const bool is_main = other == first;  // stays, also where the options ask others to be better than it
      if (!is_main && mean_distance_m(other, other + segments[s].size(), translation_m) > limit_m) continue;
      quality += segments[s].size();
      kept.push_back(s);
    }
    if (quality <= best_quality) continue;
    best_quality = quality;
    best = std::move(kept);
  }
  Segments filtered;
  for (const std::size_t s : best) filtered.push_back(segments[s]);
  return filtered;
}

}  // namespace shapemap
