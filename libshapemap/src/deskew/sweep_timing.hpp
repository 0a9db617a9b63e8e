// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"
#include "sweep_fit.hpp"

namespace shapemap {

/// Positions [first, last) of a log that follow each other without a gap.
struct SweepRun {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// From one position to the next, as a rule; 0 where stamps do not tell.
double usual_period_s(const Log& log, std::size_t first, std::size_t last);

/// The runs of [first, last) that are long enough to tell a motion. Where the times of beams are gone by, sweeps with
/// beams far from their stamps are in none.
std::vector<SweepRun> sweep_runs(const Log& log, std::size_t first, std::size_t last, double period_s,
                                 bool goes_by_beam_times);

/// When the beams of a sweep were sent.
struct BeamTiming {
  double sweep_time_s = 0.0;  ///< negative: the beams are listed from last to first; 0: all at once
  bool told = false;          ///< the log says when each beam was sent

  /// After the stamp of its sweep.
  double beam_s(const Sweep& sweep, std::size_t beam) const;
};

/// Positions [first, last), by times from the stamp of `first` on; about `max_points` points of each.
std::vector<TimedSweep> timed_sweeps(const Log& log, std::size_t first, std::size_t last, const BeamTiming& timing,
                                     const ReturnOptions& returns, std::size_t max_points);

/// How long a sweep of [first, last) takes by what the log says of its beams; 0: it does not say.
double told_sweep_time_s(const Log& log, std::size_t first, std::size_t last);

/// How long a sweep takes whose sensor goes round once a period. 0 where a position has several sub-scans of the same
/// sensor, which were not taken together.
double sweep_time_of_rate_s(const Log& log, std::size_t first, std::size_t last, double period_s);

}  // namespace shapemap
