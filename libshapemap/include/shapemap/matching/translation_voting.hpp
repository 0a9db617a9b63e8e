// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/shape/scan_view.hpp"

namespace shapemap {

struct VotingOptions {
  double cell_m = 0.20;
  double tangent_tolerance_rad = 10 * kDegree;
  double max_shift_m = 0.0;
  int peaks = 16;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"vote-cell-m", "translations this close share their votes [m]", 0.02, 2}, self.cell_m);
    visit(Field{"vote-tangent-deg", "points with tangents within this angle vote for a translation [deg]", 1, 90,
                kDegree},
          self.tangent_tolerance_rad);
    visit(Field{"max-shift-m", "longest motion between two scans [m]; 0: by how far they see, at most 8", 0, 50},
          self.max_shift_m);
    visit(Field{"vote-peaks", "translations with most votes that each rotation puts up", 1, 1000}, self.peaks);
  }
};

/// Returns the longest motion [m], along x or y, that is searched between two scans.
double max_shift_m(const ScanView& reference, const ScanView& query, const VotingOptions& options);

/// Proposes translations by votes: each pair of points with similar tangents votes for the translation that brings its
/// points together (a Hough transform, as in Ballard 1981). An object is made once for a reference and serves every
/// rotation of a query.
class TranslationVoting {
 public:
  /// Keeps a reference to `reference`.
  TranslationVoting(const ScanView& reference, double max_shift_m, const VotingOptions& options);

  /// Returns the translations [m] with most votes of `query` turned by `rotation_rad`, best first, two cells or more
  /// apart. Along a wall the votes form a ridge rather than a peak, and translations all along it are returned.
  std::vector<Point2> peaks(const ScanView& query, double rotation_rad, int max_count) const;

 private:
  using Votes = std::vector<float>;  ///< a square of cells, row by row

  Votes cast(const ScanView& query, double rotation_rad) const;
  void cast_from(const Point2& turned_m, double weight, double from_rad, double to_rad, Votes& votes) const;
  Votes blurred(const Votes& votes) const;

  const ScanView& reference_;
  VotingOptions options_;
  double max_shift_m_;
  std::size_t width_;               ///< cells along a side, with a border of one cell that gets no votes
  std::vector<std::size_t> order_;  ///< the reference's points in the order of their tangents
  std::vector<double> tangents_rad_;
};

}  // namespace shapemap
