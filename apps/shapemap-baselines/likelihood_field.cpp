// SPDX-License-Identifier: GPL-3.0-or-later
#include "likelihood_field.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap::baselines {
namespace {

constexpr double kReachSigmas = 3.0;  // the Gaussian is below 0.012 beyond this
constexpr double kCellsPerSigma = 2.0;

}  // namespace

LikelihoodField::LikelihoodField(const std::vector<OccupiedSpot>& spots, double sigma_m)
    : sigma_m_(sigma_m), cell_m_(sigma_m / kCellsPerSigma) {
  if (spots.empty()) return;
  Point2 low = spots.front().p_m;
  Point2 high = low;
  for (const OccupiedSpot& spot : spots) {
    low = low.cwiseMin(spot.p_m);
    high = high.cwiseMax(spot.p_m);
  }
  const double reach_m = kReachSigmas * sigma_m_ + cell_m_;
  origin_m_ = low.array() - reach_m;
  const Point2 size = (high - low).array() + 2 * reach_m;
  width_ = static_cast<int>(std::ceil(size.x() / cell_m_)) + 2;
  height_ = static_cast<int>(std::ceil(size.y() / cell_m_)) + 2;
  cells_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0F);
  for (const OccupiedSpot& spot : spots) stamp(spot);
}

void LikelihoodField::stamp(const OccupiedSpot& spot) {
  const int reach = static_cast<int>(std::ceil(kReachSigmas * kCellsPerSigma));
  const Point2 place = (spot.p_m - origin_m_) / cell_m_;
  const int x0 = static_cast<int>(std::lround(place.x()));
  const int y0 = static_cast<int>(std::lround(place.y()));
  const double scale = -0.5 / (kCellsPerSigma * kCellsPerSigma);
  for (int y = std::max(0, y0 - reach); y <= std::min(height_ - 1, y0 + reach); ++y) {
    float* cells = cells_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    const double share = spot.occupancy * std::exp(scale * (y - place.y()) * (y - place.y()));
    for (int x = std::max(0, x0 - reach); x <= std::min(width_ - 1, x0 + reach); ++x) {
      const double value = share * std::exp(scale * (x - place.x()) * (x - place.x()));
      cells[x] = std::max(cells[x], static_cast<float>(value));
    }
  }
}

double LikelihoodField::at(const Point2& p_m) const {
  const Point2 place = (p_m - origin_m_) / cell_m_;
  if (!(place.x() >= 0.0 && place.y() >= 0.0 && place.x() < width_ - 1 && place.y() < height_ - 1)) return 0.0;
  const int x = static_cast<int>(place.x());
  const int y = static_cast<int>(place.y());
  const double right = place.x() - x;
  const double up = place.y() - y;
  const auto along = [&](const float* cells) {
    return (1.0 - right) * static_cast<double>(cells[x]) + right * static_cast<double>(cells[x + 1]);
  };
  return (1.0 - up) * along(row(y)) + up * along(row(y + 1));
}

}  // namespace shapemap::baselines
