// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/lcs_hypotheses.hpp"

#include <algorithm>

#include "shapemap/paper/lcs.hpp"

namespace shapemap {
namespace {

Shape shape_of_view(const ScanView& view) { return {view.points, static_cast<int>(view.images.size())}; }

SimilarityIndex similarity_index(const Shape& shape) {
  const HistogramOptions histogram;
  return SimilarityIndex(features_of(shape, NeighbourDirections(shape, histogram.radius_m), 0.0, histogram.norm), {});
}

}  // namespace

LcsHypotheses::LcsHypotheses(const ScanView& reference, const ScanView& query)
    : reference_shape_(shape_of_view(reference)),
      query_shape_(shape_of_view(query)),
      query_directions_(query_shape_, HistogramOptions().radius_m),
      index_(similarity_index(reference_shape_)) {}

std::vector<Point2> LcsHypotheses::translations(double rotation_rad, int max_count) const {
  const ScanFeatures features = features_of(query_shape_, query_directions_, rotation_rad, HistogramOptions().norm);
  const std::vector<IndexPair> pairs = longest_common_subsequence(index_.matches(features));
  const Shape turned = moved(query_shape_, {0.0, 0.0, rotation_rad});
  const Correspondences correspondences = correspondences_of(pairs, turned, reference_shape_, 0);
  Segments segments = cut_into_segments(correspondences, {});
  std::stable_sort(segments.begin(), segments.end(),
                   [](const Correspondences& a, const Correspondences& b) { return a.size() > b.size(); });
  std::vector<Point2> translations_m;
  for (const Correspondences& segment : segments) {
    if (translations_m.size() == static_cast<std::size_t>(max_count)) break;
    translations_m.push_back(mean_translation_m(segment.data(), segment.data() + segment.size()));
  }
  return translations_m;
}

}  // namespace shapemap
