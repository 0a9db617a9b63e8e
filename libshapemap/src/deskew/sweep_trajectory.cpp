// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_trajectory.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

/// Other code counts knots in 32 bits; no log is so long.
constexpr double kMostKnots = 1e8;

}  // namespace

SweepTrajectory::SweepTrajectory(double first_s, double last_s, double knot_s) : first_s_(first_s), knot_s_(knot_s) {
  const double knots = std::clamp(std::ceil((last_s - first_s) / knot_s), 1.0, kMostKnots);
  controls_.assign(static_cast<std::size_t>(knots) + kOrder - 1, Eigen::Vector3d::Zero());
}

SweepTrajectory::Support SweepTrajectory::support(double time_s) const {
  const double last = static_cast<double>(controls_.size() - kOrder);
  const double at = (time_s - first_s_) / knot_s_;
  const double knot = std::clamp(std::floor(at), 0.0, last);
  const double u = std::clamp(at - knot, 0.0, 1.0);
  const double v = 1.0 - u;
  return {static_cast<std::size_t>(knot),
          {v * v * v / 6.0, (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0, (3.0 * v * v * v - 6.0 * v * v + 4.0) / 6.0,
           u * u * u / 6.0}};
}

Eigen::Vector3d SweepTrajectory::at(const Support& support) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < kOrder; ++k) sum += support.weights[k] * controls_[support.first + k];
  return sum;
}

Pose2 SweepTrajectory::pose_at(double time_s) const {
  const Eigen::Vector3d at_time = at(time_s);
  return {at_time.x(), at_time.y(), wrap_angle(at_time.z())};
}

SweepTrajectory SweepTrajectory::refined() const {
  SweepTrajectory fine = *this;
  fine.knot_s_ = 0.5 * knot_s_;
  fine.controls_.resize(2 * controls_.size() - kOrder + 1);
  for (std::size_t k = 0; k < fine.controls_.size(); ++k) {
    const std::size_t near = k / 2;
    fine.controls_[k] = k % 2 == 0 ? (0.5 * (controls_[near] + controls_[near + 1])).eval()
                                   : ((controls_[near] + 6.0 * controls_[near + 1] + controls_[near + 2]) / 8.0).eval();
  }
  return fine;
}

}  // namespace shapemap
