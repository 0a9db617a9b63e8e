// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/filters.hpp"

namespace shapemap {
namespace {

/// A mean of equal distances may come out below each of them by rounding; that must not drop them all.
constexpr double kRounding_m = 1e-9;

}  // namespace

SegmentTranslation segment_wise_translation(const Segments& segments) {
  SegmentTranslation best;
  for (const Correspondences& segment : segments) {
    SegmentTranslation candidate;
    const Correspondence* first = segment.data();
    candidate.target_from_query_m = mean_translation_m(first, first + segment.size());
    candidate.mean_distance_m = mean_distance_m(first, first + segment.size(), candidate.target_from_query_m);
    const double limit_m = candidate.mean_distance_m + kRounding_m;
    for (const Correspondences& other : segments) {
      for (const Correspondence& c : other) {
        if ((c.translation_m() - candidate.target_from_query_m).norm() > limit_m) continue;
        candidate.kept.push_back(c);
      }
    }
    candidate.num_correspondences = static_cast<int>(candidate.kept.size());
    if (candidate.num_correspondences > best.num_correspondences) best = std::move(candidate);
  }
  return best;
}

}  // namespace shapemap
