// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "shapemap/paper/filters.hpp"

namespace shapemap {
namespace {

/// What a segment is worth as the main segment.
struct MainSegment {
  Point2 translation_m{0.0, 0.0};
  std::vector<std::size_t> survivors;  ///< indices of the segments that are not much worse
  std::size_t quality = 0;             ///< correspondences in them
};

MainSegment judged_as_main(const Correspondences& segment, const Segments& segments, const FilterOptions& options) {
  MainSegment main;
  const Correspondence* first = segment.data();
  main.translation_m = mean_translation_m(first, first + segment.size());
  const double own_distance_m = mean_distance_m(first, first + segment.size(), main.translation_m);
  const double limit_m = options.segment_distance_factor * own_distance_m + options.segment_distance_slack_m;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const Correspondence* other = segments[s].data();
    const bool is_main = other == first;  // stays, also where the options ask others to be better than it
    if (!is_main && mean_distance_m(other, other + segments[s].size(), main.translation_m) > limit_m) continue;
    main.quality += segments[s].size();
    main.survivors.push_back(s);
  }
  return main;
}

}  // namespace

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

std::vector<Segments> segment_filter(const Segments& segments, const FilterOptions& options) {
  std::vector<MainSegment> mains;
  mains.reserve(segments.size());
  for (const Correspondences& main : segments) mains.push_back(judged_as_main(main, segments, options));
  std::stable_sort(mains.begin(), mains.end(),
                   [](const MainSegment& a, const MainSegment& b) { return a.quality > b.quality; });

  std::vector<Segments> best;
  std::vector<Point2> translations_m;
  for (const MainSegment& main : mains) {
    if (best.size() == static_cast<std::size_t>(options.main_segments)) break;
    const bool known = std::any_of(translations_m.begin(), translations_m.end(), [&](const Point2& other) {
      return (other - main.translation_m).norm() < options.segment_distance_slack_m;
    });
    if (known) continue;
    translations_m.push_back(main.translation_m);
    best.emplace_back();
    for (const std::size_t s : main.survivors) best.back().push_back(segments[s]);
  }
  return best;
}

}  // namespace shapemap
