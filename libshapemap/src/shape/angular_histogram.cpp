// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/angular_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shapemap/shape/point_index.hpp"

namespace shapemap {
namespace {

double divisor(const std::array<int, kHistogramBins>& counts, HistogramNorm norm) {
  switch (norm) {
    case HistogramNorm::kMaximum:
      return *std::max_element(counts.begin(), counts.end());
    case HistogramNorm::kL2:
      return std::sqrt(std::inner_product(counts.begin(), counts.end(), counts.begin(), 0.0));
    case HistogramNorm::kCount:
      break;
  }
  return std::accumulate(counts.begin(), counts.end(), 0);
}

}  // namespace

AngularHistogram normalised(const std::array<int, kHistogramBins>& counts, HistogramNorm norm) {
  AngularHistogram histogram;
  const double whole = divisor(counts, norm);
  if (whole <= 0.0) return histogram;
  for (std::size_t b = 0; b < kHistogramBins; ++b) {
    histogram.bins[b] = static_cast<std::uint8_t>(std::lround(kHistogramScale * counts[b] / whole));
  }
  return histogram;
}

NeighbourDirections::NeighbourDirections(const Shape& shape, double radius_m) {
  std::vector<Point2> points;
  points.reserve(shape.size());
  for (const ShapePoint& point : shape.points) points.push_back(point.p_m);
  const PointIndex index(points);
  first_.reserve(points.size() + 1);
  first_.push_back(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const std::size_t j : index.within(points[i], radius_m)) {
      const Point2 to = points[j] - points[i];
      if (to.squaredNorm() > 0.0) directions_rad_.push_back(std::atan2(to.y(), to.x()));
    }
    first_.push_back(directions_rad_.size());
  }
}

std::vector<AngularHistogram> NeighbourDirections::histograms(double rotation_rad, HistogramNorm norm) const {
  constexpr double kBinsPerRad = static_cast<double>(kHistogramBins) / (2.0 * kPi);
  constexpr int kBins = static_cast<int>(kHistogramBins);
  // Directions lie in [-pi, pi] and the turn in [-pi, pi]: one period more makes the bin number positive.
  const double turn_rad = wrap_angle(rotation_rad) + 2.0 * kPi;
  std::vector<AngularHistogram> result(first_.size() - 1);
  for (std::size_t i = 0; i < result.size(); ++i) {
    std::array<int, kHistogramBins> counts{};
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) {
      const int bin = static_cast<int>((directions_rad_[k] + turn_rad) * kBinsPerRad) % kBins;
      ++counts[static_cast<std::size_t>(bin)];
    }
    result[i] = normalised(counts, norm);
  }
  return result;
}

}  // namespace shapemap
