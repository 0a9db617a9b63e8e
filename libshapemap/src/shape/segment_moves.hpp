// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/shape/polyline_em.hpp"

/// These are the steps between one E and the next of the polyline fit. A segment under work is its line and the points
/// that it owns.
namespace shapemap::polyline_em {

struct WorkingSegment {
  LineSegment line;
  /// ascending indices of the points that belong to it more than to any other segment
  std::vector<std::size_t> support;
};

struct WeightedPoint {
  std::size_t point = 0;
  double weight = 0.0;
};

/// Returns the line through weighted points with the least squared orthogonal distances. It spans the projections of
/// `support` onto it, and points from the first to the last of them.
LineSegment regress(const std::vector<ScanPoint>& points, const std::vector<WeightedPoint>& weighted,
                    const std::vector<std::size_t>& support);

/// Returns the root mean square orthogonal distance of points to the infinite line.
double rms_to_line_m(const std::vector<ScanPoint>& points, const std::vector<std::size_t>& support,
                     const LineSegment& line);

/// Cuts each segment wherever two neighbours of its support, along the line, are farther apart than a surface allows.
std::vector<WorkingSegment> split_at_gaps(const std::vector<ScanPoint>& points, std::vector<WorkingSegment> segments,
                                          const PolylineOptions& options);

/// Joins pairs that are nearly collinear, close end to end and well supported together, until there are none.
std::vector<WorkingSegment> merge_collinear(const std::vector<ScanPoint>& points, std::vector<WorkingSegment> segments,
                                            const PolylineOptions& options);

/// Returns the largest distance at which two points may be neighbours on one surface.
double surface_gap_m(const ScanPoint& a, const ScanPoint& b, const PolylineOptions& options);

}  // namespace shapemap::polyline_em
