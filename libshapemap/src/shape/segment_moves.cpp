// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment_moves.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>

namespace shapemap::polyline_em {
namespace {

std::vector<WeightedPoint> with_equal_weights(const std::vector<std::size_t>& support) {
  std::vector<WeightedPoint> weighted;
  weighted.reserve(support.size());
  for (const std::size_t i : support) weighted.push_back({i, 1.0});
  return weighted;
}

bool may_be_one_surface(const std::vector<ScanPoint>& points, const WorkingSegment& before, const WorkingSegment& after,
                        const PolylineOptions& options) {
  const double angle_rad = std::acos(std::clamp(before.line.direction().dot(after.line.direction()), -1.0, 1.0));
  if (angle_rad > options.merge_angle_rad) return false;
  const ScanPoint& last = points[before.support.back()];
  const ScanPoint& first = points[after.support.front()];
  return (after.line.start_m - before.line.end_m).norm() <= surface_gap_m(last, first, options);
}

WorkingSegment joined(const std::vector<ScanPoint>& points, const WorkingSegment& a, const WorkingSegment& b) {
  WorkingSegment both;
  std::merge(a.support.begin(), a.support.end(), b.support.begin(), b.support.end(), std::back_inserter(both.support));
  both.line = regress(points, with_equal_weights(both.support), both.support);
  return both;
}

}  // namespace

double surface_gap_m(const ScanPoint& a, const ScanPoint& b, const PolylineOptions& options) {
  return options.run_gap_m + options.run_gap_beams * std::min(a.beam_spacing_m, b.beam_spacing_m);
}

LineSegment regress(const std::vector<ScanPoint>& points, const std::vector<WeightedPoint>& weighted,
                    const std::vector<std::size_t>& support) {
  double sum = 0.0;
  Point2 centre(0.0, 0.0);
  for (const WeightedPoint& w : weighted) {
    sum += w.weight;
    centre += w.weight * points[w.point].p_m;
  }
  centre /= sum;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const WeightedPoint& w : weighted) {
    const Point2 d = points[w.point].p_m - centre;
    spread += w.weight * d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread);
  Point2 direction = axes.eigenvectors().col(1);
  const Point2 along_scan = points[support.back()].p_m - points[support.front()].p_m;
  if (direction.dot(along_scan) < 0.0) direction = -direction;

  double from = std::numeric_limits<double>::infinity();
  double to = -from;
  for (const std::size_t i : support) {
    const double along = direction.dot(points[i].p_m - centre);
    from = std::min(from, along);
    to = std::max(to, along);
  }
  return {centre + from * direction, centre + to * direction};
}

double rms_to_line_m(const std::vector<ScanPoint>& points, const std::vector<std::size_t>& support,
                     const LineSegment& line) {
  const Point2 along = line.direction();
  const Point2 normal(-along.y(), along.x());
  double sum = 0.0;
  for (const std::size_t i : support) {
    const double d = normal.dot(points[i].p_m - line.start_m);
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(support.size()));
}

std::vector<WorkingSegment> split_at_gaps(const std::vector<ScanPoint>& points, std::vector<WorkingSegment> segments,
                                          const PolylineOptions& options) {
  std::vector<WorkingSegment> pieces;
  for (WorkingSegment& segment : segments) {
    const Point2 along = segment.line.direction();
    std::vector<std::size_t> ordered = segment.support;
    std::stable_sort(ordered.begin(), ordered.end(),
                     [&](std::size_t a, std::size_t b) { return along.dot(points[a].p_m) < along.dot(points[b].p_m); });
    std::vector<std::size_t> cuts{0};
    for (std::size_t k = 1; k < ordered.size(); ++k) {
      const ScanPoint& a = points[ordered[k - 1]];
      const ScanPoint& b = points[ordered[k]];
      if (along.dot(b.p_m - a.p_m) > surface_gap_m(a, b, options)) cuts.push_back(k);
    }
    if (cuts.size() == 1) {
      pieces.push_back(std::move(segment));
      continue;
    }
    cuts.push_back(ordered.size());
    for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
      WorkingSegment piece;
      piece.support.assign(ordered.begin() + static_cast<std::ptrdiff_t>(cuts[c]),
                           ordered.begin() + static_cast<std::ptrdiff_t>(cuts[c + 1]));
      std::sort(piece.support.begin(), piece.support.end());
      if (piece.support.size() < static_cast<std::size_t>(options.min_support)) continue;
      piece.line = regress(points, with_equal_weights(piece.support), piece.support);
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

std::vector<WorkingSegment> merge_collinear(const std::vector<ScanPoint>& points, std::vector<WorkingSegment> segments,
                                            const PolylineOptions& options) {
  for (std::size_t i = 0; i < segments.size();) {
    bool merged = false;
    for (std::size_t k = i + 1; k < segments.size() && !merged; ++k) {
      if (!may_be_one_surface(points, segments[i], segments[k], options)) continue;
      WorkingSegment both = joined(points, segments[i], segments[k]);
      // Each part is judged by itself, since a long wall would outvote a door frame.
      if (rms_to_line_m(points, segments[i].support, both.line) > options.em_sigma_m ||
          rms_to_line_m(points, segments[k].support, both.line) > options.em_sigma_m) {
        continue;
      }
      segments[i] = std::move(both);
      segments.erase(segments.begin() + static_cast<std::ptrdiff_t>(k));
      merged = true;
    }
    if (!merged) ++i;
  }
  return segments;
}

}  // namespace shapemap::polyline_em
