// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap::baselines {

/// What odometry would say of the way to a position: from the one before it, and how sure that is.
struct Motion {
  Pose2 previous_from_this;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, heading, in the frame of the position before
};

/// The method cannot take another position; what it has placed so far stays good.
struct CannotGoOn : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A method that makes a map scan by scan.
class SlamMethod {
 public:
  SlamMethod() = default;
  virtual ~SlamMethod() = default;
  SlamMethod(const SlamMethod&) = delete;
  SlamMethod& operator=(const SlamMethod&) = delete;

  /// `motion` is not looked at for the first position. Throws CannotGoOn.
  virtual void add(const Scan& scan, const Motion& motion) = 0;
  /// The poses of all positions so far, as they are believed now, in a frame of the method's own.
  virtual std::vector<Pose2> map_from_robot() const = 0;
};

}  // namespace shapemap::baselines
