// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "shapemap/core/pose2.hpp"
#include "shapemap/mapper/map.hpp"
#include "shapemap/mapper/map_result.hpp"

namespace shapemap {

/// What a scan is to the map.
enum class ScanRole {
  kKeyframe,  ///< others are matched to it
  kAttached,  ///< a keyframe shows the same
  kNoShape,   ///< it has too few points that tell anything, and no pose
};

/// What is known of a scan as soon as it has come.
struct ScanUpdate {
  std::size_t scan = 0;  ///< its number, from 0 on in the order in which scans come
  ScanRole role = ScanRole::kNoShape;
  /// Where it is in the map of `version`, by way of the matches since. Without a component where nothing joins it to
  /// that map; before the first map, component 0 is what matches join to the first scan with shape.
  ScanPose pose;
  MapVersion version = 0;

  std::size_t reference = kNoReference;  ///< the keyframe that it was matched to; none for the first of a session
  Pose2 reference_from_robot = kNoPose;  ///< by that match
  double probability = 0.0;              ///< that the match is right, by these two scans
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, theta) of `reference_from_robot`
};

}  // namespace shapemap
