// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/match/filters.hpp"

namespace shapemap {

SegmentTranslation segment_wise_translation(const Segments& segments) {
  SegmentTranslation best;
  for (const Correspondences& segment : segments) {
    SegmentTranslation candidate;
    const Correspondence* first = segment.data();
    candidate.target_from_query_m = mean_translation_m(first, first + segment.size());
    candidate.mean_distance_m = mean_distance_m(first, first + segment.size(), candidate.target_from_query_m);
    for (const Correspondences& other : segments) {
      for (const Correspondence& c : other) {
        if ((c.translation_m() - candidate.target_from_query_m).norm() > candidate.mean_distance_m) continue;
        candidate.kept.push_back(c);
      }
    }
    candidate.num_correspondences = static_cast<int>(candidate.kept.size());
    if (candidate.num_correspondences > best.num_correspondences) best = std::move(candidate);
  }
  return best;
}

}  // namespace shapemap
