// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/mapper/map_result.hpp"

/// Poses, and the motions between them with their covariances, are kept as text that other programs and this one read.
namespace shapemap {

struct TimedPose {
  double timestamp_s = 0.0;
  Pose2 map_from_robot;
  std::string where;  ///< file and line, for messages
};

/// Reads TUM lines `t x y z qx qy qz qw`, as tum_trajectory() writes them; only the rotation about z counts. `#` begins
/// a remark. Throws InputError, which names file and line.
std::vector<TimedPose> read_tum_trajectory(const std::string& path);

/// The robot moved so from the last placed scan to the scan of that time.
struct TimedMotion {
  double timestamp_s = 0.0;
  Pose2 previous_from_this;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of (x, y, heading), in metres and radians
  std::string where;                                     ///< file and line, for messages
};

/// Returns one motion for each placed scan, as many as tum_trajectory() has lines; the first is zero and says nothing.
/// docs/formats.md describes them. Throws ConfigError for a result of the paper's method, which has no covariances.
std::vector<TimedMotion> motions_of(const MapResult& result);
/// Returns the motions of some of the placed scans only, such as those of one session.
std::vector<TimedMotion> motions_of(const MapResult& result, const std::vector<PlacedScan>& placed);

/// Returns one line for each motion.
std::string motion_lines(const std::vector<TimedMotion>& motions);

/// Reads the lines of motion_lines(). Throws InputError, which names file and line, also for an impossible covariance.
std::vector<TimedMotion> read_motions(const std::string& path);

}  // namespace shapemap
