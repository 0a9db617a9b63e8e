// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "shapemap/core/pose2.hpp"
#include "shapemap/mapper/map.hpp"
#include "shapemap/mapper/map_result.hpp"

namespace shapemap {

/// The role of a scan in the map.
enum class ScanRole {
  kKeyframe,  ///< later scans are matched to it
  kAttached,  ///< a keyframe shows the same
  kNoShape,   ///< the scan has too few points of shape, and no pose
};

/// The result for a scan as soon as it is pushed.
struct ScanUpdate {
  std::size_t scan = 0;  ///< number of the scan, from 0 on in the order in which scans are pushed
  ScanRole role = ScanRole::kNoShape;
  /// The pose in the map of `version`, by the matches since. It has no component where no match joins the scan to that
  /// map; before the first map, component 0 has the scans that matches join to the first scan with shape.
  ScanPose pose;
  MapVersion version = 0;

  std::size_t reference = kNoReference;  ///< the keyframe that it was matched to; none for the first of a session
  Pose2 reference_from_robot = kNoPose;  ///< the pose of that match
  double probability = 0.0;              ///< probability that the match is right, by these two scans
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of (x, y, theta) of the match [m, rad]
};

}  // namespace shapemap
