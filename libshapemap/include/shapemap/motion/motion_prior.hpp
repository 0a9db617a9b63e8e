// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// How a sensor moves from scan to scan, learned from motions that are known: how far, in which direction of its own,
/// and how much it turns, each by itself (kernel density estimates). Most robots go forward by much the same step; a
/// lidar that is carried does not, and little is then learned.
class MotionPrior {
 public:
  MotionPrior() : MotionPrior(std::vector<Pose2>{}) {}
  explicit MotionPrior(const std::vector<Pose2>& known_motions);

  /// As logarithm of odds, how much less usual a motion is than the most usual one. Never much: at most what so many
  /// known motions can tell of one that was not among them; 0 where none are known.
  double surprise(const Pose2& a_from_b) const;

 private:
  double share_of_unheard_;
  std::vector<double> by_step_;       ///< relative density, in bins
  std::vector<double> by_direction_;  ///< of the way; of steps that are long enough to have one
  std::vector<double> by_turn_;
};

}  // namespace shapemap
