// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/align/partial_map.hpp"

namespace shapemap {
namespace {

std::vector<Shape> joined(const std::vector<Shape>& scans) {
  Shape all;
  for (const Shape& scan : scans) all.points.insert(all.points.end(), scan.points.begin(), scan.points.end());
  return {std::move(all)};
}

std::vector<ShapePoint> points_of(const std::vector<Shape>& shapes) {
  std::vector<ShapePoint> points;
  for (const Shape& shape : shapes) points.insert(points.end(), shape.points.begin(), shape.points.end());
  return points;
}

std::vector<Point2> coordinates_of(const std::vector<ShapePoint>& points) {
  std::vector<Point2> coordinates;
  coordinates.reserve(points.size());
  for (const ShapePoint& point : points) coordinates.push_back(point.p_m);
  return coordinates;
}

}  // namespace

PartialMap::PartialMap(std::vector<Shape> scans, bool as_one_sequence, double histogram_radius_m)
    : sequences_(as_one_sequence ? joined(scans) : std::move(scans)),
      all_points_(points_of(sequences_)),
      index_(coordinates_of(all_points_)) {
  for (const Shape& sequence : sequences_) directions_.emplace_back(sequence, histogram_radius_m);
}

}  // namespace shapemap
