// SPDX-License-Identifier: GPL-3.0-or-later
#include "placed_sweep.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

/// Points of one surface are at most this far apart, and farther the longer their range is.
constexpr double kSurfaceGap_m = 0.10;
constexpr double kSurfaceGapPerRange = 0.06;
constexpr std::size_t kSurfacePoints = 3;  ///< number of points to either side

/// A sweep is bent by less than this share of the turn of its beams, and of its usual range.
constexpr double kMostBent = 0.3;

/// A distance beyond this only says that there is no partner.
constexpr double kMisfitLimit_m = 0.25;

/// Returns the normal of the line through the points [low, high].
Point2 normal_of(const std::vector<Point2>& p_m, std::size_t low, std::size_t high) {
  Point2 mean_m(0.0, 0.0);
  for (std::size_t k = low; k <= high; ++k) mean_m += p_m[k];
  mean_m /= static_cast<double>(high - low + 1);
  double cos2 = 0.0;
  double sin2 = 0.0;
  for (std::size_t k = low; k <= high; ++k) {
    const Point2 d = p_m[k] - mean_m;
    cos2 += d.x() * d.x() - d.y() * d.y();
    sin2 += 2.0 * d.x() * d.y();
  }
  // These are the cosine and sine of the doubled angle, times a length.
  const double length = std::hypot(cos2, sin2);
  if (!(length > 0.0)) return {0.0, 0.0};
  const double along_x = std::sqrt(std::max(0.0, 0.5 * (1.0 + cos2 / length)));
  const double along_y = std::copysign(std::sqrt(std::max(0.0, 0.5 * (1.0 - cos2 / length))), sin2);
  return {-along_y, along_x};
}

double mean_distance(const PlacedSweep& from, const PlacedSweep& to) {
  double sum_m = 0.0;
  SweepNeighbours neighbours(to);
  for (std::size_t k = 0; k < from.p_m.size(); ++k) {
    const PointIndex::Neighbour near = neighbours.nearest(from.p_m[k], kMisfitLimit_m);
    double distance_m = kMisfitLimit_m;
    if (near.distance_m <= kMisfitLimit_m) {
      const Point2& normal = to.normals[near.point];
      distance_m = normal.isZero() ? near.distance_m : std::abs(normal.dot(from.p_m[k] - to.p_m[near.point]));
    }
    sum_m += distance_m;
  }
  return sum_m / std::max<double>(1.0, static_cast<double>(from.p_m.size()));
}

}  // namespace

PointIndex::Neighbour SweepNeighbours::nearest(const Point2& p_m, double gate_m) {
  constexpr double kRounding = 1e-9;
  double within_m = gate_m;
  if (last_ < sweep_.p_m.size()) {
    within_m = std::min(within_m, (sweep_.p_m[last_] - p_m).norm() * (1.0 + kRounding) + kRounding);
  }
  const PointIndex::Neighbour near = sweep_.index.nearest(p_m, within_m);
  if (near.distance_m <= gate_m) last_ = near.point;
  return near;
}

bool is_implausible(const TimedSweep& sweep, const SweepTrajectory& trajectory) {
  const Eigen::Vector3d moved = trajectory.at(sweep.last_s) - trajectory.at(sweep.first_s);
  if (sweep.last_s == sweep.first_s) return false;
  // The comparison is written so that NaN is implausible.
  return !(std::abs(moved.z()) < kMostBent * sweep.turned_rad &&
           moved.head<2>().norm() < std::max(kMostBent * sweep.usual_range_m, kSurfaceGap_m));
}

PlacedSweep placed_sweep(const TimedSweep& sweep, const SweepTrajectory& trajectory) {
  PlacedSweep placed;
  const std::size_t num = sweep.points.size();
  placed.p_m.reserve(num);
  std::vector<double> gap_m;
  gap_m.reserve(num);
  for (const TimedPoint& point : sweep.points) {
    const Eigen::Vector3d at = trajectory.at(point.time_s);
    placed.p_m.push_back(rotate(point.p_m, at.z()) + at.head<2>());
    gap_m.push_back(kSurfaceGap_m + kSurfaceGapPerRange * point.p_m.norm());
  }
  placed.normals.assign(num, Point2(0.0, 0.0));
  for (std::size_t k = 0; k < num; ++k) {
    std::size_t low = k;
    while (low > 0 && k - low < kSurfacePoints && !sweep.points[low].begins_line &&
           (placed.p_m[low] - placed.p_m[low - 1]).norm() < gap_m[low]) {
      --low;
    }
    std::size_t high = k;
    while (high + 1 < num && high - k < kSurfacePoints && !sweep.points[high + 1].begins_line &&
           (placed.p_m[high + 1] - placed.p_m[high]).norm() < gap_m[high]) {
      ++high;
    }
    if (high - low >= 2) placed.normals[k] = normal_of(placed.p_m, low, high);
  }
  placed.index = PointIndex(placed.p_m);
  return placed;
}

double sweep_misfit(const PlacedSweep& a, const PlacedSweep& b) {
  return 0.5 * (mean_distance(a, b) + mean_distance(b, a));
}

}  // namespace shapemap
