// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/core/pose2.hpp"

/// The points of a scan are approximated by polylines, with expectation maximisation and perceptual grouping (paper,
/// section II-A).
namespace shapemap {

struct PolylineOptions {
  double run_gap_m = 0.20;
  double run_gap_beams = 5.0;
  double simplify_tolerance_m = 0.05;
  double em_sigma_m = 0.02;
  int em_max_iterations = 20;
  int min_support = 2;
  double merge_angle_rad = 10 * kDegree;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"run-gap-m", "points farther apart are not on one surface [m], plus", 0, 10}, self.run_gap_m);
    visit(Field{"run-gap-beams", "this many times the spacing of the beams there", 0, 100}, self.run_gap_beams);
    visit(Field{"simplify-tolerance-m", "first polylines keep this close to the points [m]", 0.001, 1},
          self.simplify_tolerance_m);
    visit(Field{"em-sigma-m", "spread of points about their segment [m]", 0.001, 1}, self.em_sigma_m);
    visit(Field{"em-max-iterations", "rounds of EM, splitting and merging", 0, 1000}, self.em_max_iterations);
    visit(Field{"min-support", "points that a segment needs", 2, 1000}, self.min_support);
    visit(Field{"merge-angle-deg", "segments within this angle may be one [deg]", 0, 90, kDegree},
          self.merge_angle_rad);
  }
};

/// A segment has a direction, which follows the order of the scan.
struct LineSegment {
  Point2 start_m{0.0, 0.0};
  Point2 end_m{0.0, 0.0};

  Point2 direction() const { return (end_m - start_m).normalized(); }
  double tangent_rad() const { return std::atan2(end_m.y() - start_m.y(), end_m.x() - start_m.x()); }
  double length_m() const { return (end_m - start_m).norm(); }
  double distance_m(const Point2& p) const;  ///< distance to the nearest point of the segment, ends included
};

/// A scan point comes with the spacing that neighbouring beams have at its range (range times beam step).
struct ScanPoint {
  Point2 p_m{0.0, 0.0};
  double beam_spacing_m = 0.0;
};

struct PolylineFit {
  std::vector<LineSegment> segments;  ///< in the order of the scan
  std::vector<int> closest_segment;   ///< per point; -1 only when there are no segments
  int iterations = 0;
};

/// Returns the runs of points between range jumps, as index pairs [first, last).
std::vector<std::pair<std::size_t, std::size_t>> surface_runs(const std::vector<ScanPoint>& points,
                                                              const PolylineOptions& options);

/// Fits line segments to the points of one sweep, in the order of the sweep. The fit starts from CGAL's simplification
/// of each run. It then alternates until the segments are stable: E computes the probability of each point under each
/// segment from its distance; M is weighted orthogonal regression, with the segment trimmed to its support; segments
/// split where their support has a gap; segments that are nearly collinear, close end to end and well supported
/// together merge.
PolylineFit fit_polylines(const std::vector<ScanPoint>& points, const PolylineOptions& options);

}  // namespace shapemap
