// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/scan_view.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>

namespace shapemap {
namespace {

constexpr std::size_t kSmoothingBins = 3;

std::size_t tangent_bin(double tangent_rad) {
  const double turns = tangent_rad / (2.0 * kPi);
  const auto bin = static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(kTangentBins));
  return std::min(bin, kTangentBins - 1);
}

/// Each point counts in its own bin and, with falling weight, in those beside it.
TangentHistogram tangent_histogram(const std::vector<ShapePoint>& points) {
  TangentHistogram histogram{};
  for (const ShapePoint& point : points) {
    const std::size_t lowest = tangent_bin(point.tangent_rad) + kTangentBins - kSmoothingBins;
    for (std::size_t k = 0; k <= 2 * kSmoothingBins; ++k) {
      const std::size_t away = k < kSmoothingBins ? kSmoothingBins - k : k - kSmoothingBins;
      histogram[(lowest + k) % kTangentBins] += 1.0 - static_cast<double>(away) / (kSmoothingBins + 1.0);
    }
  }
  return histogram;
}

/// Returns the mean direction that the surfaces run along, without orientation.
Point2 main_direction(const std::vector<Point2>& directions) {
  double cos2 = 0.0;
  double sin2 = 0.0;
  for (const Point2& d : directions) {
    cos2 += d.x() * d.x() - d.y() * d.y();
    sin2 += 2.0 * d.x() * d.y();
  }
  const double angle_rad = 0.5 * std::atan2(sin2, cos2);
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

void add_weights(ScanView& view) {
  const Point2 along = main_direction(view.directions);
  for (std::size_t i = 0; i < view.size(); ++i) {
    const double alike = view.tangents[tangent_bin(view.points[i].tangent_rad)];
    view.weights.push_back(1.0 / std::sqrt(std::max(1.0, alike)));
    const Point2& d = view.directions[i];
    const double across = along.x() * d.y() - along.y() * d.x();
    view.cross_weights.push_back(across * across);
  }
}

double reach_m(const std::vector<RangeImage>& images) {
  std::vector<double> ranges_m;
  for (const RangeImage& image : images) {
    for (const RangeImage::Beam& beam : image.beams) {
      if (beam.range_m > 0.0) ranges_m.push_back(beam.range_m);
    }
  }
  if (ranges_m.empty()) return 0.0;
  const auto ninth = ranges_m.begin() + static_cast<std::ptrdiff_t>(ranges_m.size() * 9 / 10);
  std::nth_element(ranges_m.begin(), ninth, ranges_m.end());
  return *ninth;
}

/// The share counts sectors, wide enough for single lost beams not to matter.
double seen_share(const std::vector<ShapePoint>& points, const std::vector<RangeImage>& images) {
  constexpr std::size_t kSectors = 36;
  std::bitset<kSectors> seen;
  std::vector<Point2> sensors_m;
  for (const RangeImage& image : images) sensors_m.push_back(inverse(image.sensor_from_robot).translation());
  for (const ShapePoint& point : points) {
    const Point2 from_sensor_m = point.p_m - sensors_m[static_cast<std::size_t>(point.sweep)];
    const double turns = std::atan2(from_sensor_m.y(), from_sensor_m.x()) / (2.0 * kPi);
    const auto sector = static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(kSectors));
    seen.set(std::min(sector, kSectors - 1));
  }
  return static_cast<double>(seen.count()) / static_cast<double>(kSectors);
}

}  // namespace

bool looks_all_round(const ScanView& view) {
  constexpr double kAllRound_rad = 330 * kDegree;
  double seen_rad = 0.0;
  for (const RangeImage& image : view.images) seen_rad += image.step_rad * static_cast<double>(image.beams.size());
  return seen_rad >= kAllRound_rad;
}

ScanView view_of(const Scan& scan, const ReturnOptions& returns, const PolylineOptions& polylines,
                 const ShapeOptions& shape, const ViewOptions& options) {
  ScanView view;
  std::vector<ShapePoint> all;
  for (std::size_t s = 0; s < scan.sweeps.size(); ++s) {
    const SweepShape part = sweep_shape(scan.sweeps[s], static_cast<int>(s), returns, polylines, shape);
    all.insert(all.end(), part.shape_points.begin(), part.shape_points.end());
    view.images.push_back(range_image(scan.sweeps[s], part));
  }
  view.tangents = tangent_histogram(all);
  view.reach_m = reach_m(view.images);
  view.seen_share = seen_share(all, view.images);

  const auto max_points = static_cast<std::size_t>(options.max_points);
  const std::size_t step = std::max<std::size_t>(1, (all.size() + max_points - 1) / max_points);
  std::vector<Point2> places_m;
  for (std::size_t i = step / 2; i < all.size(); i += step) {
    view.points.push_back(all[i]);
    view.directions.emplace_back(std::cos(all[i].tangent_rad), std::sin(all[i].tangent_rad));
    places_m.push_back(all[i].p_m);
  }
  add_weights(view);
  view.index = PointIndex(std::move(places_m));
  return view;
}

}  // namespace shapemap
