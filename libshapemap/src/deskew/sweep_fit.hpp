// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "placed_sweep.hpp"
#include "sweep_trajectory.hpp"

namespace shapemap {

struct SweepFitOptions {
  double first_gate_m = 0.5;
  double last_gate_m = 0.12;
  int iterations = 6;
  double still = 2e-4;     ///< smaller steps change nothing that matters [m, rad]
  std::size_t stride = 1;  ///< every n-th point takes part, n being the stride
  int threads = 1;
};

/// The sweeps [first, last) are fitted, and the control points from `first_free` on may move.
struct SweepFitRange {
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t first_free = 0;
};

/// Moves `trajectory` so that the points of each of the sweeps [first, last) lie on the surfaces that its neighbours
/// saw; what moves is what these sweeps depend on, but for control points below `first_free`.
void fit_sweeps(const std::vector<TimedSweep>& sweeps, const SweepFitRange& range, const SweepFitOptions& options,
                SweepTrajectory& trajectory);

}  // namespace shapemap
