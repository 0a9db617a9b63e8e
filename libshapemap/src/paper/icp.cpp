// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/icp.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

/// An iteration that moves the query by less than this changes nothing that can be seen in a map.
constexpr double kStillMotion_m = 1e-5;
constexpr double kStillTurn_rad = 1e-6;

std::vector<Partner> closer_than(const std::vector<Partner>& partners, double distance_m) {
  std::vector<Partner> closer;
  for (const Partner& partner : partners) {
    if (partner.distance_m <= distance_m) closer.push_back(partner);
  }
  return closer;
}

bool is_worse(const ScanOverlap& after, const ScanOverlap& before) {
  return after.num_points < before.num_points && after.mean_distance_m > before.mean_distance_m;
}

bool is_still(const Pose2& after, const Pose2& before) {
  return (after.translation() - before.translation()).norm() < kStillMotion_m &&
         angle_between(after.theta_rad, before.theta_rad) < kStillTurn_rad;
}

Shape only_sweep(const Shape& shape, int sweep) {
  Shape part;
  part.num_sweeps = 1;
  std::copy_if(shape.points.begin(), shape.points.end(), std::back_inserter(part.points),
               [&](const ShapePoint& point) { return point.sweep == sweep; });
  return part;
}

}  // namespace

Pose2 fit_pose(const PartialMap& target, const Shape& query, const std::vector<Partner>& partners) {
  Point2 query_centre(0.0, 0.0);
  Point2 target_centre(0.0, 0.0);
  for (const Partner& partner : partners) {
    query_centre += query.points[partner.query].p_m;
    target_centre += target.point(partner.target).p_m;
  }
  query_centre /= static_cast<double>(partners.size());
  target_centre /= static_cast<double>(partners.size());
  double dot = 0.0;
  double cross = 0.0;
  for (const Partner& partner : partners) {
    const Point2 q = query.points[partner.query].p_m - query_centre;
    const Point2 t = target.point(partner.target).p_m - target_centre;
    dot += q.dot(t);
    cross += q.x() * t.y() - q.y() * t.x();
  }
  const double theta_rad = std::atan2(cross, dot);
  const Point2 translation_m = target_centre - rotate(query_centre, theta_rad);
  return {translation_m.x(), translation_m.y(), theta_rad};
}

IcpResult icp(const PartialMap& target, const Shape& query, const IcpStart& start, const IcpOptions& options,
              const OverlapOptions& overlap_options) {
  IcpResult result;
  result.target_from_query = start.target_from_query;
  result.steps.push_back(start.target_from_query);
  double limit_m = start.mean_distance_m + overlap_options.slack_m;
  std::vector<Partner> partners = partners_within(target, query, start.target_from_query, {limit_m}, overlap_options);
  // From here on the thresholds follow the mean distance of the scan points that the start aligns.
  const double aligned_m = scan_overlap(partners).mean_distance_m;
  limit_m = aligned_m + overlap_options.slack_m;
  partners = partners_within(target, query, start.target_from_query, {limit_m}, overlap_options);
  result.overlap = scan_overlap(partners);

  while (result.iterations < options.max_iterations) {
    const double gate_m =
        options.gate == IcpGate::kFactor ? options.gate_factor * result.overlap.mean_distance_m : limit_m;
    const std::vector<Partner> pulling = closer_than(partners, gate_m);
    if (pulling.size() < 3) break;
    const Pose2 moved_pose = fit_pose(target, query, pulling);
    partners = partners_within(target, query, moved_pose, {limit_m}, overlap_options);
    const ScanOverlap overlap = scan_overlap(partners);
    if (is_worse(overlap, result.overlap)) break;
    const bool still = is_still(moved_pose, result.target_from_query);
    result.target_from_query = moved_pose;
    result.overlap = overlap;
    ++result.iterations;
    result.steps.push_back(moved_pose);
    if (still) break;
  }
  return result;
}

std::vector<Pose2> decoupled_icp(const PartialMap& target, const Shape& query, const IcpStart& start,
                                 const IcpOptions& options, const OverlapOptions& overlap_options) {
  std::vector<Pose2> query_from_sweep(static_cast<std::size_t>(query.num_sweeps));
  if (query.num_sweeps < 2) return query_from_sweep;
  for (int s = 0; s < query.num_sweeps; ++s) {
    const IcpResult refined = icp(target, only_sweep(query, s), start, options, overlap_options);
    const Pose2 correction = inverse(start.target_from_query) * refined.target_from_query;
    const bool small = correction.translation().norm() <= options.decoupled_max_shift_m &&
                       std::abs(correction.theta_rad) <= options.decoupled_max_turn_rad;
    if (small) query_from_sweep[static_cast<std::size_t>(s)] = correction;
  }
  return query_from_sweep;
}

}  // namespace shapemap
