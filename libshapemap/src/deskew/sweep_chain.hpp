// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "sweep_fit.hpp"
#include "sweep_trajectory.hpp"

namespace shapemap {

/// How a robot moved while it took `sweeps`, which follow each other without a gap, and how well these go together
/// then.
struct SweepMotion {
  SweepTrajectory trajectory;
  std::vector<double> misfit_m;  ///< of each sweep with the one before; 0 for the first
};

/// `keep_going` is told how many sweeps are done, and asked whether to go on; false ends it with Interrupted.
SweepMotion sweep_motion(const std::vector<TimedSweep>& sweeps, double period_s, int threads,
                         const std::function<bool(std::size_t done)>& keep_going);

/// The same of a few sweeps, by a search that is made to be quick.
struct ShortMotion {
  SweepTrajectory trajectory;
  double misfit_m = 0.0;  ///< the mean of all that follow each other
};
ShortMotion short_motion(const std::vector<TimedSweep>& sweeps, double period_s);

}  // namespace shapemap
