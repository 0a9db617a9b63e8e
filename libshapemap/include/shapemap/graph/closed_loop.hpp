// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// Two places that are known to be near each other though the log came to them at different times.
struct ClosedLoop {
  std::size_t a = 0;  ///< index of a position; the earlier one
  std::size_t b = 0;
  Pose2 a_from_b;         ///< of the best of the alignments behind it
  double strength = 0.0;  ///< log odds of these, summed
};

}  // namespace shapemap
