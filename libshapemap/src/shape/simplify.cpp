// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/simplify.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyline_simplification_2/Squared_distance_cost.h>
#include <CGAL/Polyline_simplification_2/Stop_above_cost_threshold.h>
#include <CGAL/Polyline_simplification_2/simplify.h>

#include <algorithm>
#include <iterator>
#include <optional>

namespace shapemap {
namespace {

namespace simplification = CGAL::Polyline_simplification_2;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertices = std::vector<Kernel::Point_2>;

// CGAL refuses a line that crosses itself here, since computing the crossings with rounding can recurse without end.
using Triangulation = CGAL::Constrained_triangulation_plus_2<CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<simplification::Vertex_base_2<Kernel>,
                                         CGAL::Constrained_triangulation_face_base_2<Kernel>>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>>;

/// Returns the vertices that CGAL keeps, in order, or nothing when the line crosses or touches itself: CGAL's own lists
/// break where a line runs over one of its vertices again.
std::optional<Vertices> simplified(const Vertices& vertices, double tolerance_m) {
  try {
    Triangulation triangulation;
    const auto line = triangulation.insert_constraint(vertices.begin(), vertices.end());
    const auto begin = triangulation.vertices_in_constraint_begin(line);
    const auto end = triangulation.vertices_in_constraint_end(line);
    const bool meets_itself = triangulation.number_of_vertices() != vertices.size() ||
                              static_cast<std::size_t>(std::distance(begin, end)) != vertices.size();
    if (meets_itself) return std::nullopt;
    simplification::simplify(triangulation, line, simplification::Squared_distance_cost(),
                             simplification::Stop_above_cost_threshold(tolerance_m * tolerance_m));
    return Vertices(triangulation.points_in_constraint_begin(line), triangulation.points_in_constraint_end(line));
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    return std::nullopt;
  }
}

/// Simplifies a line that meets itself in halves, and those likewise: two points meet nothing.
Vertices simplified_in_parts(const Vertices& vertices, double tolerance_m) {
  if (vertices.size() <= 2) return vertices;
  if (std::optional<Vertices> simple = simplified(vertices, tolerance_m)) return *std::move(simple);
  const auto middle = vertices.begin() + static_cast<std::ptrdiff_t>(vertices.size() / 2);
  Vertices parts = simplified_in_parts({vertices.begin(), middle + 1}, tolerance_m);
  const Vertices rest = simplified_in_parts({middle, vertices.end()}, tolerance_m);
  parts.insert(parts.end(), rest.begin() + 1, rest.end());
  return parts;
}

}  // namespace

std::vector<std::size_t> simplify_polyline(const std::vector<Point2>& points, double tolerance_m) {
  std::vector<std::size_t> kept;
  Vertices vertices;
  std::vector<std::size_t> index_of_vertex;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) continue;  // CGAL's predicates know no NaN
    const Kernel::Point_2 vertex(points[i].x(), points[i].y());
    if (!vertices.empty() && vertices.back() == vertex) continue;  // the triangulation wants distinct neighbours
    vertices.push_back(vertex);
    index_of_vertex.push_back(i);
  }

  // CGAL returns points, in order and unchanged, so walking both lists recovers the indices.
  std::size_t from = 0;
  for (const Kernel::Point_2& point : simplified_in_parts(vertices, tolerance_m)) {
    const auto found = std::find(vertices.begin() + static_cast<std::ptrdiff_t>(from), vertices.end(), point);
    const auto v = static_cast<std::size_t>(found - vertices.begin());
    kept.push_back(index_of_vertex[v]);
    from = v + 1;
  }
  return kept;
}

}  // namespace shapemap
