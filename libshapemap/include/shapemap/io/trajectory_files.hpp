// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/mapper/map_result.hpp"

/// Poses, and the motions between them with their covariances, as text that other programs and ours read.
namespace shapemap {

struct TimedPose {
  double timestamp_s = 0.0;
  Pose2 map_from_robot;
  std::string where;  ///< file and line, for messages
};

/// TUM lines `t x y z qx qy qz qw`, as tum_trajectory() writes them; of the turn the part about z is taken. `#` begins
/// a remark. Throws InputError naming file and line.
std::vector<TimedPose> read_tum_trajectory(const std::string& path);

/// How the robot came to the position of that time from the placed position before it.
struct TimedMotion {
  double timestamp_s = 0.0;
  Pose2 previous_from_this;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, heading, in metres and radians
  std::string where;                                     ///< file and line, for messages
};

/// One for each placed position, as many as tum_trajectory() has lines; that of the first is zero and says nothing. See
/// docs/formats.md. Throws ConfigError for a result of the paper's method, which knows no covariances.
std::vector<TimedMotion> motions_of(const MapResult& result);
/// Of some of the placed positions only, such as those of one log.
std::vector<TimedMotion> motions_of(const MapResult& result, const std::vector<PlacedScan>& placed);

/// One line for each motion.
std::string motion_lines(const std::vector<TimedMotion>& motions);

/// Reads what motion_lines() writes. Throws InputError naming file and line, also for a covariance that is none.
std::vector<TimedMotion> read_motions(const std::string& path);

}  // namespace shapemap
