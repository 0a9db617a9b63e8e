// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/graph/loop_closing.hpp"

namespace shapemap {

/// Nineteen of twenty sure steps of the chain are shorter, and turn less.
struct UsualMotion {
  double step_m;
  double turn_rad;
};

UsualMotion usual_motion(const std::vector<ChainLink>& links);

}  // namespace shapemap
