// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/core/options.hpp"
#include "shapemap/shape/scan_view.hpp"

/// Whether two scans can have been taken at a given relative pose, judged by what each saw of the other's surfaces and
/// of the space in front of them.
namespace shapemap {

struct VisibilityOptions {
  double agree_m = 0.10;
  double agree_tangent_rad = 25 * kDegree;
  double see_through_m = 0.20;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"agree-m", "a point this close to the surface that the other scan saw there agrees [m]", 0.01, 1},
          self.agree_m);
    visit(Field{"agree-tangent-deg", "if its tangent is within this angle, too [deg]", 1, 180, kDegree},
          self.agree_tangent_rad);
    visit(Field{"see-through-m", "a point this far in front of it has been looked through [m]", 0.01, 5},
          self.see_through_m);
  }
};

/// What became of the points of both scans, each looked at from the other scan's sensors: sums of their weights. Points
/// behind a surface, or beyond the field of view, speak neither for a pose nor against it.
struct Visibility {
  double agree = 0.0;        ///< on the surface that the other scan saw there
  double crossed = 0.0;      ///< in the way of one of the other scan's beams
  double hidden = 0.0;       ///< behind a surface that the other scan saw
  double unclear = 0.0;      ///< near such a surface but not like it, or where there was no return
  double outside = 0.0;      ///< outside the field of view
  double cross_agree = 0.0;  ///< as `agree`, with ScanView::cross_weights
  double cross_total = 0.0;

  double total() const { return agree + crossed + hidden + unclear + outside; }
  Visibility& operator+=(const Visibility& other);
};

/// Looks at every `stride`-th point of each scan. `slack` widens the distances, for poses that are not refined yet.
Visibility visibility(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                      const VisibilityOptions& options, double slack = 1.0, std::size_t stride = 1);

/// How well the scans go together, as the logarithm of odds up to a constant: grows with the share of points that agree
/// and falls with the share that beams would have had to pass through. Shares, and not sums, so that moving less, which
/// lets more points be seen by both, is no merit of its own.
double visibility_score(const Visibility& visibility);

}  // namespace shapemap
