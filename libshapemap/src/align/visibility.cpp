// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/align/visibility.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

enum class Seen { kOutside, kHidden, kUnclear, kCrossed, kAgree };  // the later, the stronger the evidence

struct Limits {
  double agree_m;
  double see_through_m;
  double cos_tangent;
};

/// A point of the other scan, in the robot's frame of the scan that looks at it.
struct SeenPoint {
  Point2 p_m;
  Point2 direction;
};

Seen look_along_beam(const RangeImage::Beam& beam, const SeenPoint& point, double range_m, const Limits& limits) {
  if (beam.range_m <= 0.0) return Seen::kUnclear;
  const Point2 off_m = point.p_m - beam.hit_m;
  const double before_m = off_m.dot(beam.normal);
  const double reach_m = limits.agree_m + 1.5 * beam.footprint_m;
  if (std::abs(before_m) < limits.agree_m && off_m.squaredNorm() < reach_m * reach_m) {
    const Point2 tangent(beam.normal.y(), -beam.normal.x());  // the normal is to the left of it
    return tangent.dot(point.direction) > limits.cos_tangent ? Seen::kAgree : Seen::kUnclear;
  }
  if (before_m > limits.agree_m && beam.range_m - range_m > limits.see_through_m) return Seen::kCrossed;
  return range_m - beam.range_m > limits.see_through_m ? Seen::kHidden : Seen::kUnclear;
}

/// By the beam towards the point and its neighbours: one of them suffices to agree, all are needed to cross. Edges of
/// things are never certain to a beam.
Seen look(const RangeImage& image, const SeenPoint& point, const Limits& limits) {
  const Point2 in_sensor_m = image.sensor_from_robot * point.p_m;
  const int middle = image.beam_at(std::atan2(in_sensor_m.y(), in_sensor_m.x()));
  if (middle < 0) return Seen::kOutside;
  const double range_m = in_sensor_m.norm();
  const int last = static_cast<int>(image.beams.size()) - 1;
  Seen weakest = Seen::kAgree;
  for (int k = std::max(0, middle - 1); k <= std::min(last, middle + 1); ++k) {
    const Seen seen = look_along_beam(image.beams[static_cast<std::size_t>(k)], point, range_m, limits);
    if (seen == Seen::kAgree) return seen;
    weakest = std::min(weakest, seen);
  }
  return weakest;
}

double& share(Visibility& sum, Seen seen) {
  switch (seen) {
    case Seen::kAgree:
      return sum.agree;
    case Seen::kCrossed:
      return sum.crossed;
    case Seen::kHidden:
      return sum.hidden;
    case Seen::kUnclear:
      return sum.unclear;
    case Seen::kOutside:
      break;
  }
  return sum.outside;
}

/// The points of `seen` from the sensors of `seer`.
Visibility one_way(const ScanView& seer, const ScanView& seen, const Pose2& seer_from_seen, const Limits& limits,
                   std::size_t stride) {
  Visibility sum;
  const Turn turn(seer_from_seen.theta_rad);
  for (std::size_t i = stride / 2; i < seen.size(); i += stride) {
    const SeenPoint point{turn * seen.points[i].p_m + seer_from_seen.translation(), turn * seen.directions[i]};
    Seen best = Seen::kOutside;
    for (const RangeImage& image : seer.images) best = std::max(best, look(image, point, limits));
    share(sum, best) += seen.weights[i];
    sum.cross_total += seen.cross_weights[i];
    if (best == Seen::kAgree) sum.cross_agree += seen.cross_weights[i];
  }
  return sum;
}

}  // namespace

Visibility& Visibility::operator+=(const Visibility& other) {
  agree += other.agree;
  crossed += other.crossed;
  hidden += other.hidden;
  unclear += other.unclear;
  outside += other.outside;
  cross_agree += other.cross_agree;
  cross_total += other.cross_total;
  return *this;
}

Visibility visibility(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                      const VisibilityOptions& options, double slack, std::size_t stride) {
  const Limits limits{options.agree_m * slack, options.see_through_m * slack, std::cos(options.agree_tangent_rad)};
  Visibility sum = one_way(reference, query, ref_from_query, limits, stride);
  sum += one_way(query, reference, inverse(ref_from_query), limits, stride);
  return sum;
}

double visibility_score(const Visibility& v) {
  constexpr double kNothing = 1e-9;
  const double agree = (v.agree + 0.25 * v.unclear) / (v.total() + kNothing);
  const double cross_agree = v.cross_agree / (v.cross_total + kNothing);
  const double crossed = v.crossed / (v.total() + kNothing);
  return 6.5 * std::log(0.05 + agree) + 1.0 * std::log(0.05 + cross_agree) - 2.7 * std::log(0.02 + crossed);
}

}  // namespace shapemap
