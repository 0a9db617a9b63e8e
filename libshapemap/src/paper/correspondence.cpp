// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/correspondence.hpp"

namespace shapemap {

Correspondences correspondences_of(const std::vector<IndexPair>& pairs, const Shape& query, const Shape& target,
                                   std::size_t target_scan) {
  Correspondences correspondences;
  correspondences.reserve(pairs.size());
  for (const IndexPair& pair : pairs) {
    const ShapePoint& q = query.points[pair.query];
    const ShapePoint& t = target.points[pair.target];
    correspondences.push_back({q.p_m, t.p_m, q.tangent_rad, t.tangent_rad, pair, target_scan});
  }
  return correspondences;
}

Point2 mean_translation_m(const Correspondence* first, const Correspondence* last) {
  Point2 sum(0.0, 0.0);
  for (const Correspondence* c = first; c != last; ++c) sum += c->translation_m();
  return sum / static_cast<double>(last - first);
}

double mean_distance_m(const Correspondence* first, const Correspondence* last, const Point2& translation_m) {
  double sum = 0.0;
  for (const Correspondence* c = first; c != last; ++c) sum += (c->translation_m() - translation_m).norm();
  return sum / static_cast<double>(last - first);
}

}  // namespace shapemap
