// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "sweep_fit.hpp"
#include "sweep_trajectory.hpp"

namespace shapemap {

/// The robot moved so while it took successive sweeps, which match each other with these misfits.
struct SweepMotion {
  SweepTrajectory trajectory;
  std::vector<double> misfit_m;  ///< misfit of each sweep with the one before; 0 for the first
};

/// Estimates the motion of `sweeps`, which follow each other without a gap. `keep_going` learns how many sweeps are
/// done; when it returns false, the estimate ends by throwing Interrupted.
SweepMotion sweep_motion(const std::vector<TimedSweep>& sweeps, double period_s, int threads,
                         const std::function<bool(std::size_t done)>& keep_going);

/// A quick search finds the motion of a few sweeps.
struct ShortMotion {
  SweepTrajectory trajectory;
  double misfit_m = 0.0;  ///< mean over all pairs of successive sweeps
};
ShortMotion short_motion(const std::vector<TimedSweep>& sweeps, double period_s);

}  // namespace shapemap
