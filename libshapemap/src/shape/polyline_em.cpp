// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/polyline_em.hpp"

#include <algorithm>
#include <limits>

#include "segment_moves.hpp"
#include "shapemap/shape/simplify.hpp"

namespace shapemap {
namespace {

using polyline_em::WeightedPoint;
using polyline_em::WorkingSegment;

/// A segment does not explain points that are farther off than this many sigmas.
constexpr double kMaxSigmas = 3.0;

std::vector<WorkingSegment> initial_segments(const std::vector<ScanPoint>& points, const PolylineOptions& options) {
  std::vector<WorkingSegment> segments;
  for (const auto& [first, last] : surface_runs(points, options)) {
    std::vector<Point2> run;
    for (std::size_t i = first; i < last; ++i) run.push_back(points[i].p_m);
    const std::vector<std::size_t> vertices = simplify_polyline(run, options.simplify_tolerance_m);
    for (std::size_t v = 0; v + 1 < vertices.size(); ++v) {
      segments.push_back({{run[vertices[v]], run[vertices[v + 1]]}, {}});
    }
  }
  return segments;
}

/// Computes the probability of each point under each segment, with one share for "none of them".
std::vector<std::vector<WeightedPoint>> expectation(const std::vector<ScanPoint>& points,
                                                    std::vector<WorkingSegment>& segments, double sigma_m) {
  const double reach_m = kMaxSigmas * sigma_m;
  const double none = std::exp(-0.5 * kMaxSigmas * kMaxSigmas);
  std::vector<std::vector<WeightedPoint>> weighted(segments.size());
  for (WorkingSegment& segment : segments) segment.support.clear();
  std::vector<std::pair<std::size_t, double>> likely;  // pairs of segment and likelihood
  for (std::size_t i = 0; i < points.size(); ++i) {
    likely.clear();
    double sum = none;
    for (std::size_t s = 0; s < segments.size(); ++s) {
      const double d = segments[s].line.distance_m(points[i].p_m);
      if (d > reach_m) continue;
      likely.emplace_back(s, std::exp(-0.5 * (d / sigma_m) * (d / sigma_m)));
      sum += likely.back().second;
    }
    if (likely.empty()) continue;
    std::size_t owner = 0;
    for (std::size_t k = 0; k < likely.size(); ++k) {
      weighted[likely[k].first].push_back({i, likely[k].second / sum});
      if (likely[k].second > likely[owner].second) owner = k;
    }
    segments[likely[owner].first].support.push_back(i);
  }
  return weighted;
}

std::vector<WorkingSegment> maximisation(const std::vector<ScanPoint>& points, std::vector<WorkingSegment> segments,
                                         const std::vector<std::vector<WeightedPoint>>& weighted, int min_support) {
  std::vector<WorkingSegment> supported;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    WorkingSegment& segment = segments[s];
    if (segment.support.size() < static_cast<std::size_t>(min_support)) continue;
    segment.line = polyline_em::regress(points, weighted[s], segment.support);
    if (segment.line.length_m() > 0.0) supported.push_back(std::move(segment));
  }
  return supported;
}

std::vector<int> closest_segments(const std::vector<ScanPoint>& points, const std::vector<LineSegment>& segments) {
  std::vector<int> closest(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double best_m = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < segments.size(); ++s) {
      const double d = segments[s].distance_m(points[i].p_m);
      if (d >= best_m) continue;
      best_m = d;
      closest[i] = static_cast<int>(s);
    }
  }
  return closest;
}

bool same_supports(const std::vector<WorkingSegment>& a, const std::vector<WorkingSegment>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& s, const auto& t) { return s.support == t.support; });
}

}  // namespace

double LineSegment::distance_m(const Point2& p) const {
  const Point2 along = end_m - start_m;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(along.dot(p - start_m) / length2, 0.0, 1.0) : 0.0;
  return (p - (start_m + t * along)).norm();
}

std::vector<std::pair<std::size_t, std::size_t>> surface_runs(const std::vector<ScanPoint>& points,
                                                              const PolylineOptions& options) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  std::size_t first = 0;
  for (std::size_t i = 1; i <= points.size(); ++i) {
    const bool ends = i == points.size() || (points[i].p_m - points[i - 1].p_m).norm() >
                                                polyline_em::surface_gap_m(points[i - 1], points[i], options);
    if (!ends) continue;
    if (i - first >= 2) runs.emplace_back(first, i);
    first = i;
  }
  return runs;
}

PolylineFit fit_polylines(const std::vector<ScanPoint>& points, const PolylineOptions& options) {
  PolylineFit fit;
  std::vector<WorkingSegment> segments = initial_segments(points, options);
  std::vector<WorkingSegment> before;
  while (fit.iterations < options.em_max_iterations) {
    ++fit.iterations;
    const auto weighted = expectation(points, segments, options.em_sigma_m);
    segments = maximisation(points, std::move(segments), weighted, options.min_support);
    segments = polyline_em::split_at_gaps(points, std::move(segments), options);
    segments = polyline_em::merge_collinear(points, std::move(segments), options);
    if (same_supports(segments, before)) break;
    before = segments;
  }
  if (fit.iterations > 0) {  // before the first iteration, segments are in scan order and own no points yet
    std::stable_sort(segments.begin(), segments.end(), [](const WorkingSegment& a, const WorkingSegment& b) {
      return a.support.front() < b.support.front();
    });
  }
  for (const WorkingSegment& segment : segments) fit.segments.push_back(segment.line);
  fit.closest_segment = closest_segments(points, fit.segments);
  return fit;
}

}  // namespace shapemap
