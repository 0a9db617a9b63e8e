// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "shapemap/core/pose2.hpp"

namespace shapemap::baselines {

struct ClimbSteps {
  double step_m = 0.1;
  double step_rad = 0.05;
  int halvings = 4;
};

/// Climbs from `start`: takes the best of steps ahead, back, left, right and turns to both sides as long as there is a
/// better one, then halves the steps, `halvings` times.
Pose2 climb(const Pose2& start, const std::function<double(const Pose2&)>& score, ClimbSteps steps);

}  // namespace shapemap::baselines
