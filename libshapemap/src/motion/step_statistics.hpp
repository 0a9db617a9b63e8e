// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// Nineteen of twenty steps are shorter, and turn less.
struct StepStatistics {
  double step_m;
  double turn_rad;
};

/// Of steps that are known, `a_from_b` each.
StepStatistics step_statistics(const std::vector<Pose2>& steps);

}  // namespace shapemap
