// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/point_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace shapemap {

namespace {
constexpr std::size_t kLeafPoints = 16;  // measured to be quicker to build and to search than the default of 10
}  // namespace

struct PointIndex::Tree {
  explicit Tree(std::vector<Point2> p)
      : points(std::move(p)), index(2, *this, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafPoints)) {
    if (!points.empty()) index.buildIndex();
  }

  // nanoflann asks a data set for these three functions.
  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }

  std::vector<Point2> points;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree>, Tree, 2, std::size_t> index;
};

PointIndex::PointIndex(std::vector<Point2> points) : tree_(std::make_unique<Tree>(std::move(points))) {}
PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;
PointIndex& PointIndex::operator=(PointIndex&&) noexcept = default;

std::size_t PointIndex::size() const { return tree_->points.size(); }

PointIndex::Neighbour PointIndex::nearest(const Point2& p, double max_distance_m) const {
  if (tree_->points.empty()) return {};
  std::size_t point = tree_->points.size();
  double distance2 = 0.0;
  nanoflann::KNNResultSet<double> found(1);
  found.init(&point, &distance2);
  // The search skips points that are not closer than its worst so far, but a point exactly at the distance counts.
  distance2 = std::nextafter(max_distance_m * max_distance_m, std::numeric_limits<double>::infinity());
  tree_->index.findNeighbors(found, p.data(), nanoflann::SearchParams());
  if (point == tree_->points.size()) return {};
  return {point, std::sqrt(distance2)};
}

std::vector<std::size_t> PointIndex::within(const Point2& p, double radius_m) const {
  std::vector<std::size_t> neighbours;
  if (tree_->points.empty()) return neighbours;
  std::vector<std::pair<std::size_t, double>> found;
  nanoflann::SearchParams unsorted;
  unsorted.sorted = false;
  // nanoflann takes the radius squared, and leaves out points exactly at it.
  const double beyond2 = std::nextafter(radius_m * radius_m, std::numeric_limits<double>::infinity());
  tree_->index.radiusSearch(p.data(), beyond2, found, unsorted);
  neighbours.reserve(found.size());
  for (const auto& [point, distance2] : found) neighbours.push_back(point);
  std::sort(neighbours.begin(), neighbours.end());
  return neighbours;
}

}  // namespace shapemap
