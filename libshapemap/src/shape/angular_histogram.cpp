// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/angular_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

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
    if (counts[b] == 0) continue;                                                              // most bins are empty
    histogram.bins[b] = static_cast<std::uint8_t>(kHistogramScale * counts[b] / whole + 0.5);  // rounds to the nearest
  }
  return histogram;
}

NeighbourDirections::NeighbourDirections(const Shape& shape, double radius_m) {
  // The points are swept by x. Each pair is met once and gives two directions, opposite to each other.
  struct Pair {
    std::uint32_t from;
    std::uint32_t to;
    double direction_rad;
  };
  std::vector<std::uint32_t> order(shape.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return shape.points[a].p_m.x() < shape.points[b].p_m.x(); });
  std::vector<Point2> ordered_m;
  ordered_m.reserve(order.size());
  for (const std::uint32_t i : order) ordered_m.push_back(shape.points[i].p_m);
  std::vector<Pair> pairs;
  std::vector<std::size_t> counts(shape.size(), 0);
  const double radius2 = radius_m * radius_m;
  for (std::size_t k = 0; k < order.size(); ++k) {
    for (std::size_t l = k + 1; l < order.size(); ++l) {
      const Point2 to = ordered_m[l] - ordered_m[k];
      if (to.x() > radius_m) break;
      const double distance2 = to.squaredNorm();
      if (distance2 > radius2 || distance2 == 0.0) continue;
      pairs.push_back({order[k], order[l], std::atan2(to.y(), to.x())});
      ++counts[order[k]];
      ++counts[order[l]];
    }
  }
  first_.resize(shape.size() + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), first_.begin() + 1);
  directions_rad_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const Pair& pair : pairs) {
    directions_rad_[next[pair.from]++] = pair.direction_rad;
    directions_rad_[next[pair.to]++] = pair.direction_rad > 0.0 ? pair.direction_rad - kPi : pair.direction_rad + kPi;
  }
}

std::vector<AngularHistogram> NeighbourDirections::histograms(double rotation_rad, HistogramNorm norm) const {
  constexpr double kBinsPerRad = static_cast<double>(kHistogramBins) / (2.0 * kPi);
  // Directions and the turn lie in [-pi, pi]: with one period more, bin numbers are 0 to twice the number of bins.
  constexpr std::size_t kUnfolded = 2 * kHistogramBins + 1;
  const double turn_rad = wrap_angle(rotation_rad) + 2.0 * kPi;
  const auto bin_of = [&](double direction_rad) {
    return static_cast<std::size_t>(static_cast<int>((direction_rad + turn_rad) * kBinsPerRad));
  };
  std::vector<AngularHistogram> result(first_.size() - 1);
  for (std::size_t i = 0; i < result.size(); ++i) {
    // Neighbours often have like directions. Two counters that take turns need not wait for each other.
    std::array<int, kUnfolded> even{};
    std::array<int, kUnfolded> odd{};
    std::size_t k = first_[i];
    for (; k + 1 < first_[i + 1]; k += 2) {
      ++even[bin_of(directions_rad_[k])];
      ++odd[bin_of(directions_rad_[k + 1])];
    }
    if (k < first_[i + 1]) ++even[bin_of(directions_rad_[k])];
    std::array<int, kHistogramBins> counts{};
    for (std::size_t b = 0; b < kHistogramBins; ++b) {
      counts[b] = even[b] + even[b + kHistogramBins] + odd[b] + odd[b + kHistogramBins];
    }
    counts[0] += even.back() + odd.back();
    result[i] = normalised(counts, norm);
  }
  return result;
}

}  // namespace shapemap
