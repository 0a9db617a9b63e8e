// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// Nineteen of twenty steps are shorter than `step_m` and turn by less than `turn_rad`.
struct StepStatistics {
  double step_m;
  double turn_rad;
};

/// Computes the statistics of known steps, each `a_from_b`; lower bounds replace those of too few steps.
StepStatistics step_statistics(const std::vector<Pose2>& steps);

}  // namespace shapemap
