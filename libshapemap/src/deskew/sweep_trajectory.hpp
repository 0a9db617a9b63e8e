// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// A trajectory gives the pose of a robot as a smooth function of time: a uniform cubic B-spline of x, y and the
/// heading, which counts whole turns.
class SweepTrajectory {
 public:
  static constexpr std::size_t kOrder = 4;

  /// A time depends on these control points with these weights.
  struct Support {
    std::size_t first = 0;
    std::array<double, kOrder> weights{};
  };

  /// The trajectory stands at the origin from `first_s` to `last_s`; its knots are `knot_s` apart.
  SweepTrajectory(double first_s, double last_s, double knot_s);

  Support support(double time_s) const;
  Eigen::Vector3d at(const Support& support) const;
  Eigen::Vector3d at(double time_s) const { return at(support(time_s)); }
  Pose2 pose_at(double time_s) const;
  /// Returns the same motion with twice as many knots.
  SweepTrajectory refined() const;

  double knot_s() const { return knot_s_; }
  /// Returns the time at which a control point has most weight.
  double time_of(std::size_t control) const { return first_s_ + (static_cast<double>(control) - 1.0) * knot_s_; }
  std::vector<Eigen::Vector3d>& controls() { return controls_; }
  const std::vector<Eigen::Vector3d>& controls() const { return controls_; }

 private:
  double first_s_;
  double knot_s_;
  std::vector<Eigen::Vector3d> controls_;
};

}  // namespace shapemap
