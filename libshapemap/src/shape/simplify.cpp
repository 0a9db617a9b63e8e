// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/simplify.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyline_simplification_2/Squared_distance_cost.h>
#include <CGAL/Polyline_simplification_2/Stop_above_cost_threshold.h>
#include <CGAL/Polyline_simplification_2/simplify.h>

#include <algorithm>
#include <iterator>

namespace shapemap {

std::vector<std::size_t> simplify_polyline(const std::vector<Point2>& points, double tolerance_m) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  namespace simplification = CGAL::Polyline_simplification_2;

  std::vector<std::size_t> kept;
  std::vector<Kernel::Point_2> vertices;
  std::vector<std::size_t> index_of_vertex;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Kernel::Point_2 vertex(points[i].x(), points[i].y());
    if (!vertices.empty() && vertices.back() == vertex) continue;  // the triangulation wants distinct neighbours
    vertices.push_back(vertex);
    index_of_vertex.push_back(i);
  }
  if (vertices.size() <= 2) return index_of_vertex;

  std::vector<Kernel::Point_2> simple;
  simplification::simplify(vertices.begin(), vertices.end(), simplification::Squared_distance_cost(),
                           simplification::Stop_above_cost_threshold(tolerance_m * tolerance_m),
                           std::back_inserter(simple));
  // CGAL gives points, in order and unchanged, to which it adds one where the polyline crosses itself: walk both
  // lists to get the indices back, and pass over what is not ours.
  std::size_t from = 0;
  for (const Kernel::Point_2& point : simple) {
    const auto found = std::find(vertices.begin() + static_cast<std::ptrdiff_t>(from), vertices.end(), point);
    if (found == vertices.end()) continue;
    const auto v = static_cast<std::size_t>(found - vertices.begin());
    kept.push_back(index_of_vertex[v]);
    from = v + 1;
  }
  return kept;
}

}  // namespace shapemap
