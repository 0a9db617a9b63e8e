// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/paper/lcs.hpp"
#include "shapemap/shape/shape.hpp"

/// Paper, section II-C: corresponding points of a query scan and a target scan.
namespace shapemap {

/// Two points that are taken for the same place. A correspondence is a hypothesis until the filters have passed it.
struct Correspondence {
  Point2 query_m{0.0, 0.0};  ///< turned by the rotation under test, not translated
  Point2 target_m{0.0, 0.0};
  double query_tangent_rad = 0.0;  ///< turned likewise
  double target_tangent_rad = 0.0;
  IndexPair indices;  ///< into the query shape and the target scan's shape
  std::size_t target_scan = 0;

  /// The paper's correspondence vector.
  Point2 translation_m() const { return target_m - query_m; }
};

using Correspondences = std::vector<Correspondence>;

/// Looks up the points behind index pairs. `query` is the turned shape.
Correspondences correspondences_of(const std::vector<IndexPair>& pairs, const Shape& query, const Shape& target,
                                   std::size_t target_scan);

/// Returns the average translation vector of the correspondences [first, last).
Point2 mean_translation_m(const Correspondence* first, const Correspondence* last);

/// Returns the average distance between corresponding points after the query has been moved by `translation_m`.
double mean_distance_m(const Correspondence* first, const Correspondence* last, const Point2& translation_m);

}  // namespace shapemap
