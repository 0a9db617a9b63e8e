// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// A loop: the robot came to one place at two different times, and matches hold its two keyframes to each other.
struct ClosedLoop {
  std::size_t a = 0;  ///< index of the earlier scan
  std::size_t b = 0;
  Pose2 a_from_b;         ///< pose of the best match of the loop
  double strength = 0.0;  ///< sum of the log odds of its matches
};

}  // namespace shapemap
