// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/scan_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace shapemap {
namespace {

std::optional<Partner> nearest_partner(const PartialMap& target, const Point2& p_m, double tangent_rad,
                                       double max_distance_m, double tolerance_rad) {
  const PointIndex::Neighbour nearest = target.index().nearest(p_m, max_distance_m);
  if (!std::isfinite(nearest.distance_m)) return std::nullopt;
  if (angle_between(target.point(nearest.point).tangent_rad, tangent_rad) > tolerance_rad) return std::nullopt;
  return Partner{0, nearest.point, nearest.distance_m};
}

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
                                     const PartnerLimits& limits, const OverlapOptions& options) {
  const auto find = options.rule == OverlapRule::kNearest ? nearest_partner : nearest_similar_partner;
  std::vector<Partner> partners;
  for (std::size_t i = 0; i < query.size(); ++i) {
    if (partners.size() + query.size() - i < limits.at_least) break;
    const ShapePoint& point = query.points[i];
    std::optional<Partner> partner =
        find(target, target_from_query * point.p_m, point.tangent_rad + target_from_query.theta_rad,
             limits.max_distance_m, options.tangent_tolerance_rad);
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
