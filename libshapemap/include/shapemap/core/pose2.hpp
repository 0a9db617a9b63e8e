// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "shapemap/core/angles.hpp"

namespace shapemap {

using Point2 = Eigen::Vector2d;

/// A pose is a rigid motion of the plane. A variable named `b_from_a` takes coordinates in frame a to frame b, so that
/// `c_from_b * b_from_a` reads as `c_from_a`.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double theta_rad = 0.0;

  Point2 translation() const { return {x_m, y_m}; }
};

/// This value stands where there is no pose.
inline constexpr Pose2 kNoPose{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::quiet_NaN()};

/// A rotation that keeps its sine and cosine, for turning many points.
class Turn {
 public:
  explicit Turn(double angle_rad) : cos_(std::cos(angle_rad)), sin_(std::sin(angle_rad)) {}
  Point2 operator*(const Point2& p) const { return {cos_ * p.x() - sin_ * p.y(), sin_ * p.x() + cos_ * p.y()}; }

 private:
  double cos_;
  double sin_;
};

inline Point2 rotate(const Point2& p, double angle_rad) { return Turn(angle_rad) * p; }

inline Point2 operator*(const Pose2& b_from_a, const Point2& p_in_a) {
  return rotate(p_in_a, b_from_a.theta_rad) + b_from_a.translation();
}

inline Pose2 operator*(const Pose2& c_from_b, const Pose2& b_from_a) {
  const Point2 t = c_from_b * b_from_a.translation();
  return {t.x(), t.y(), wrap_angle(c_from_b.theta_rad + b_from_a.theta_rad)};
}

inline Pose2 inverse(const Pose2& b_from_a) {
  const Point2 t = rotate(-b_from_a.translation(), -b_from_a.theta_rad);
  return {t.x(), t.y(), wrap_angle(-b_from_a.theta_rad)};
}

/// How far two poses may lie apart and still count as one, in place and in heading.
struct PoseTolerance {
  double m = 0.0;
  double rad = 0.0;
};

/// Says whether a motion is shorter, and turns by less, than the tolerance.
inline bool is_within(const Pose2& motion, const PoseTolerance& tolerance) {
  return motion.translation().norm() < tolerance.m && std::abs(motion.theta_rad) < tolerance.rad;
}

/// Says whether two poses in one frame are the same place up to the tolerance: the motion between them is within it.
inline bool agrees(const Pose2& one, const Pose2& other, const PoseTolerance& tolerance) {
  return (one.translation() - other.translation()).norm() < tolerance.m &&
         angle_between(one.theta_rad, other.theta_rad) < tolerance.rad;
}

inline bool operator==(const Pose2& a, const Pose2& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.theta_rad == b.theta_rad;
}

}  // namespace shapemap
