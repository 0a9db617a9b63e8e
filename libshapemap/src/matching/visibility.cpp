// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/visibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "beam_lookup.hpp"
#include "matching_numbers.hpp"

namespace shapemap {
namespace {

enum class Seen { kOutside, kHidden, kUnclear, kCrossed, kAgree };  // ordered by strength of the evidence

struct Limits {
  double agree_m;
  double see_through_m;
  double cos_tangent;
};

/// A point of the other scan, in the robot's frame of the scan that sees it.
struct SeenPoint {
  Point2 p_m;
  Point2 direction;
};

/// Points that one range image sees. What needs no beam is computed for all of them at once, which is vectorised.
class PointBatch {
 public:
  static constexpr std::size_t kMost = 64;

  void add(const Point2& p_m, const Point2& direction) { points_[size_++] = {p_m, direction}; }
  std::size_t size() const { return size_; }
  const SeenPoint& point(std::size_t i) const { return points_[i]; }

  void turn_to(const RangeImage& image) {
    const Turn turn(image.sensor_from_robot.theta_rad);
    for (std::size_t i = 0; i < size_; ++i) {
      const Point2 in_sensor_m = turn * points_[i].p_m + image.sensor_from_robot.translation();
      x_m_[i] = in_sensor_m.x();
      y_m_[i] = in_sensor_m.y();
    }
    for (std::size_t i = 0; i < size_; ++i) {
      range_m_[i] = std::sqrt(x_m_[i] * x_m_[i] + y_m_[i] * y_m_[i]);
      bearing_rad_[i] = approximate_bearing_rad(x_m_[i], y_m_[i]);
    }
  }

  double range_m(std::size_t i) const { return range_m_[i]; }
  int beam(const RangeImage& image, std::size_t i) const {
    return beam_near(image, bearing_rad_[i], {x_m_[i], y_m_[i]});
  }

 private:
  std::size_t size_ = 0;
  std::array<SeenPoint, kMost> points_;
  std::array<double, kMost> x_m_;
  std::array<double, kMost> y_m_;
  std::array<double, kMost> range_m_;
  std::array<double, kMost> bearing_rad_;
};

Seen seen_along_beam(const RangeImage::Beam& beam, const SeenPoint& point, double range_m, const Limits& limits) {
  if (beam.range_m <= 0.0) return Seen::kUnclear;
  const Point2 off_m = point.p_m - beam.hit_m;
  const double before_m = off_m.dot(beam.normal);
  const double reach_m = limits.agree_m + kMatching.visibility.footprints * beam.footprint_m;
  if (std::abs(before_m) < limits.agree_m && off_m.squaredNorm() < reach_m * reach_m) {
    const Point2 tangent(beam.normal.y(), -beam.normal.x());  // the normal is to the left of it
    return tangent.dot(point.direction) > limits.cos_tangent ? Seen::kAgree : Seen::kUnclear;
  }
  if (before_m > limits.agree_m && beam.range_m - range_m > limits.see_through_m) return Seen::kCrossed;
  return range_m - beam.range_m > limits.see_through_m ? Seen::kHidden : Seen::kUnclear;
}

/// Uses the beam towards the point and the beams beside it, because the edge of an object is never certain to a beam:
/// one of them suffices to agree, and all must cross.
Seen seen_by(const RangeImage& image, int middle, const SeenPoint& point, double range_m, const Limits& limits) {
  if (middle < 0) return Seen::kOutside;
  const int last = static_cast<int>(image.beams.size()) - 1;
  Seen weakest = Seen::kAgree;
  for (const int k : {middle, middle - 1, middle + 1}) {
    if (k < 0 || k > last) continue;
    const Seen seen = seen_along_beam(image.beams[static_cast<std::size_t>(k)], point, range_m, limits);
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

/// Compares the points of `seen` with what the sensors of `seer` saw.
Visibility one_way(const ScanView& seer, const ScanView& seen, const Pose2& seer_from_seen, const Limits& limits,
                   std::size_t stride) {
  Visibility sum;
  const Turn turn(seer_from_seen.theta_rad);
  for (std::size_t first = stride / 2; first < seen.size(); first += PointBatch::kMost * stride) {
    PointBatch batch;
    for (std::size_t i = first; i < seen.size() && batch.size() < PointBatch::kMost; i += stride) {
      batch.add(turn * seen.points[i].p_m + seer_from_seen.translation(), turn * seen.directions[i]);
    }
    std::array<Seen, PointBatch::kMost> best;
    best.fill(Seen::kOutside);
    for (const RangeImage& image : seer.images) {
      batch.turn_to(image);
      for (std::size_t k = 0; k < batch.size(); ++k) {
        best[k] = std::max(best[k], seen_by(image, batch.beam(image, k), batch.point(k), batch.range_m(k), limits));
      }
    }
    for (std::size_t k = 0; k < batch.size(); ++k) {
      const std::size_t i = first + k * stride;
      share(sum, best[k]) += seen.weights[i];
      sum.cross_total += seen.cross_weights[i];
      if (best[k] == Seen::kAgree) sum.cross_agree += seen.cross_weights[i];
    }
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
                      const VisibilityOptions& options, const VisibilityPrecision& precision) {
  const Limits limits{options.agree_m * precision.slack, options.see_through_m * precision.slack,
                      std::cos(options.agree_tangent_rad)};
  Visibility sum = one_way(reference, query, ref_from_query, limits, precision.stride);
  sum += one_way(query, reference, inverse(ref_from_query), limits, precision.stride);
  return sum;
}

double visibility_score(const Visibility& v) {
  const double nothing = 1e-9;  // avoids a division by zero
  const ScoreWeights& weights = kMatching.score;
  const double agree = (v.agree + weights.unclear_share * v.unclear) / (v.total() + nothing);
  const double cross_agree = v.cross_agree / (v.cross_total + nothing);
  const double crossed = v.crossed / (v.total() + nothing);
  return weights.agree * std::log(weights.agree_offset + agree) +
         weights.cross_agree * std::log(weights.cross_agree_offset + cross_agree) +
         weights.crossed * std::log(weights.crossed_offset + crossed);
}

}  // namespace shapemap
