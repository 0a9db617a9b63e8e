// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// The prior says how a sensor moves from scan to scan. It is learned from known motions by kernel density estimates of
/// their length, their direction in the sensor's frame and their turn, which are taken as independent. Most robots go
/// forward by much the same step; a lidar carried by hand does not, and little is then learned.
class MotionPrior {
 public:
  MotionPrior() : MotionPrior(std::vector<Pose2>{}) {}
  explicit MotionPrior(const std::vector<Pose2>& known_motions);

  /// Returns how much less usual a motion is than the most usual one, as a logarithm of odds (>= 0). The surprise is
  /// bounded by what so many known motions can say of an unknown one; it is 0 where none are known.
  double surprise(const Pose2& a_from_b) const;

 private:
  double share_of_unheard_;
  std::vector<double> by_step_;       ///< relative density, in bins
  std::vector<double> by_direction_;  ///< density of the direction of steps that are long enough to have one
  std::vector<double> by_turn_;
};

}  // namespace shapemap
