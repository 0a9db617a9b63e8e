// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap::baselines {

/// The motion to a scan from the one before it, as odometry would give it, and its uncertainty.
struct Motion {
  Pose2 previous_from_this;
  /// covariance of (x, y, heading), in the frame of the scan before
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// The method cannot take another scan; its poses so far stay good.
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

  /// Adds a scan; `motion` has no meaning for the first one. Throws CannotGoOn.
  virtual void add(const Scan& scan, const Motion& motion) = 0;
  /// Returns the current estimates of all poses so far, in a frame of the method's own.
  virtual std::vector<Pose2> map_from_robot() const = 0;
};

}  // namespace shapemap::baselines
