// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// Finds neighbours among points of the plane with nanoflann's kd-tree. It keeps a copy of the points.
class PointIndex {
 public:
  struct Neighbour {
    std::size_t point = 0;
    double distance_m = std::numeric_limits<double>::infinity();
  };

  explicit PointIndex(std::vector<Point2> points);
  ~PointIndex();
  PointIndex(PointIndex&&) noexcept;
  PointIndex& operator=(PointIndex&&) noexcept;

  std::size_t size() const;
  /// Returns the nearest point at most `max_distance_m` away; the distance is infinite when there is none.
  Neighbour nearest(const Point2& p, double max_distance_m = std::numeric_limits<double>::infinity()) const;
  /// Returns all points within `radius_m`, by ascending index.
  std::vector<std::size_t> within(const Point2& p, double radius_m) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace shapemap
