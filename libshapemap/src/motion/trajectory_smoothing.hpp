// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// A trajectory has such a pose for each of its scans.
struct TrackedPose {
  std::size_t scan_index = 0;  ///< consecutive scans of a recording have consecutive indices
  std::size_t session = 0;     ///< the session that the scan is from
  Pose2 map_from_robot;
  /// The covariance of (x, y, theta) in the map frame; without one the pose stays as it is.
  std::optional<Eigen::Matrix3d> covariance;
};

/// Smooths a trajectory in place. Scans between keyframes are placed one by one, and along a bare corridor that says
/// little. Where scans follow each other closely, each of them is drawn towards the middle between the one before and
/// the one after, by as much as its covariance allows. Time plays no part, because recorded times are often not those
/// of the scans. `poses` is in the order of the scans.
void smooth_trajectory(std::vector<TrackedPose>& poses);

}  // namespace shapemap
