// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/core/options.hpp"
#include "shapemap/shape/scan_view.hpp"

/// Visibility is the evidence for a relative pose of two scans: what each saw of the other's surfaces, and of the space
/// in front of them.
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

/// Sums of the weights of the points of both scans, by how the sensors of the other scan saw each of them. Points
/// behind a surface, or beyond the field of view, are no evidence.
struct Visibility {
  double agree = 0.0;        ///< on the surface that the other scan saw there
  double crossed = 0.0;      ///< between the other scan's sensor and what its beam hit
  double hidden = 0.0;       ///< behind a surface that the other scan saw
  double unclear = 0.0;      ///< near such a surface but not on it, or where a beam had no return
  double outside = 0.0;      ///< outside the field of view
  double cross_agree = 0.0;  ///< as `agree`, with ScanView::cross_weights
  double cross_total = 0.0;  ///< as total(), with ScanView::cross_weights

  double total() const { return agree + crossed + hidden + unclear + outside; }
  Visibility& operator+=(const Visibility& other);
};

/// How coarse a comparison of two scans is.
struct VisibilityPrecision {
  double slack = 1.0;      ///< factor on the distances of VisibilityOptions, larger for poses that are not refined
  std::size_t stride = 1;  ///< every such point of each scan is compared
};

/// Compares two scans at a relative pose.
Visibility visibility(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                      const VisibilityOptions& options, const VisibilityPrecision& precision = {});

/// Returns the log odds, up to a constant, that the pose is right: they grow with the share of points that agree and
/// fall with the share that is crossed. Shares rather than sums are used, because a shorter motion lets both scans see
/// more points, which is no evidence for it.
double visibility_score(const Visibility& visibility);

}  // namespace shapemap
