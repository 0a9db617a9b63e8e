// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// A scan of a trajectory.
struct TrackedPose {
  std::size_t scan_index = 0;  ///< scans that were recorded one after the other have indices that do so
  std::size_t session = 0;     ///< the recording that the scan is from
  Pose2 map_from_robot;
  /// Of (x, y, theta), in the frame of the map; none: the pose stays as it is.
  std::optional<Eigen::Matrix3d> covariance;
};

/// Scans that keyframes stand for are placed one by one, and along a bare corridor that says little. Where scans follow
/// each other closely, each of them is drawn towards the middle between the one before and the one after, by as much as
/// its covariance allows. Not by time: recorded times are often not those of the scans. `poses` is in the order of the
/// scans.
void smooth_trajectory(std::vector<TrackedPose>& poses);

}  // namespace shapemap
