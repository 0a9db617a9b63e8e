// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/partial_map.hpp"

namespace shapemap {
namespace {

std::vector<TargetScan> target_scans(const std::vector<Shape>& scans, bool as_one_sequence, double histogram_radius_m) {
  std::vector<TargetScan> targets;
  if (!as_one_sequence) {
    for (const Shape& scan : scans) targets.push_back(target_scan(scan, histogram_radius_m));
    return targets;
  }
  Shape all;
  for (const Shape& scan : scans) all.points.insert(all.points.end(), scan.points.begin(), scan.points.end());
  targets.push_back(target_scan(std::move(all), histogram_radius_m));
  return targets;
}

std::vector<ShapePoint> points_of(const std::vector<TargetScan>& scans) {
  std::vector<ShapePoint> points;
  for (const TargetScan& scan : scans) points.insert(points.end(), scan.shape.points.begin(), scan.shape.points.end());
  return points;
}

std::vector<Point2> coordinates_of(const std::vector<ShapePoint>& points) {
  std::vector<Point2> coordinates;
  coordinates.reserve(points.size());
  for (const ShapePoint& point : points) coordinates.push_back(point.p_m);
  return coordinates;
}

}  // namespace

TargetScan target_scan(Shape shape, double histogram_radius_m) {
  auto directions = std::make_shared<const NeighbourDirections>(shape, histogram_radius_m);
  return {std::move(shape), std::move(directions), 0.0};
}

TargetScan moved(const TargetScan& scan, const Pose2& b_from_a) {
  return {moved(scan.shape, b_from_a), scan.directions, wrap_angle(scan.turned_rad + b_from_a.theta_rad)};
}

PartialMap::PartialMap(std::vector<TargetScan> scans)
    : sequences_(std::move(scans)), all_points_(points_of(sequences_)), index_(coordinates_of(all_points_)) {}

PartialMap::PartialMap(const std::vector<Shape>& scans, bool as_one_sequence, double histogram_radius_m)
    : PartialMap(target_scans(scans, as_one_sequence, histogram_radius_m)) {}

}  // namespace shapemap
