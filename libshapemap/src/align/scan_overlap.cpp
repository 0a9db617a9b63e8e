// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/align/scan_overlap.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

/// The nearest target point to each of many points in a row.
class NearestPartner {
 public:
  NearestPartner(const PartialMap& target, double max_distance_m, double tolerance_rad)
      : target_(target), max_distance_m_(max_distance_m), tolerance_rad_(tolerance_rad) {}

  std::optional<Partner> operator()(const Point2& p_m, double tangent_rad) {
    // Neighbours have near partners: the last one bounds the search. With a margin, so that rounding cannot hide a
    // point which is exactly as near.
    constexpr double kMargin = 1.0 + 1e-9;
    const double bound_m =
        has_last_ ? std::min(max_distance_m_, kMargin * (target_.point(last_).p_m - p_m).norm()) : max_distance_m_;
    const PointIndex::Neighbour nearest = target_.index().nearest(p_m, bound_m);
    if (!std::isfinite(nearest.distance_m)) return std::nullopt;
    last_ = nearest.point;
    has_last_ = true;
    if (angle_between(target_.point(nearest.point).tangent_rad, tangent_rad) > tolerance_rad_) return std::nullopt;
    return Partner{0, nearest.point, nearest.distance_m};
  }

 private:
  const PartialMap& target_;
  double max_distance_m_;
  double tolerance_rad_;
  std::size_t last_ = 0;
  bool has_last_ = false;
};

std::optional<Partner> nearest_similar_partner(const PartialMap& target, const Point2& p_m, double tangent_rad,
                                               double max_distance_m, double tolerance_rad) {
  // Most partners are near: a few small circles hold far fewer points than the largest one.
  constexpr double kFirstShare = 1.0 / 16.0;
  for (double radius_m = kFirstShare * max_distance_m;; radius_m = std::min(2.0 * radius_m, max_distance_m)) {
    std::optional<Partner> best;
    for (const std::size_t t : target.index().within(p_m, radius_m)) {
      if (angle_between(target.point(t).tangent_rad, tangent_rad) > tolerance_rad) continue;
      const double distance_m = (target.point(t).p_m - p_m).norm();
      if (!best || distance_m < best->distance_m) best = Partner{0, t, distance_m};
    }
    if (best || !(radius_m < max_distance_m)) return best;
  }
}

}  // namespace

std::vector<Partner> partners_within(const PartialMap& target, const Shape& query, const Pose2& target_from_query,
                                     double max_distance_m, const OverlapOptions& options, std::size_t at_least) {
  NearestPartner nearest(target, max_distance_m, options.tangent_tolerance_rad);
  std::vector<Partner> partners;
  partners.reserve(query.size());
  for (std::size_t i = 0; i < query.size(); ++i) {
    if (partners.size() + query.size() - i < at_least) break;
    const ShapePoint& point = query.points[i];
    const Point2 p_m = target_from_query * point.p_m;
    const double tangent_rad = point.tangent_rad + target_from_query.theta_rad;
    std::optional<Partner> partner =
        options.rule == OverlapRule::kNearest
            ? nearest(p_m, tangent_rad)
            : nearest_similar_partner(target, p_m, tangent_rad, max_distance_m, options.tangent_tolerance_rad);
    if (!partner) continue;
    partner->query = i;
    partners.push_back(*partner);
  }
  return partners;
}

ScanOverlap scan_overlap(const std::vector<Partner>& partners) {
  ScanOverlap overlap;
  overlap.num_points = static_cast<int>(partners.size());
  if (partners.empty()) return overlap;
  for (const Partner& partner : partners) overlap.mean_distance_m += partner.distance_m;
  overlap.mean_distance_m /= static_cast<double>(partners.size());
  return overlap;
}

}  // namespace shapemap
