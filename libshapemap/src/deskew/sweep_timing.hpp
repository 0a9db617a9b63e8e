// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"
#include "sweep_fit.hpp"

namespace shapemap {

/// The scans [first, last) of a run follow each other without a gap.
struct SweepRun {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Returns the usual time from one scan to the next, or 0 where the stamps do not tell it.
double usual_period_s(const std::vector<Scan>& scans, std::size_t first, std::size_t last);

/// Returns the runs of [first, last) that are long enough to estimate a motion. Where the times of beams are used,
/// sweeps with beams far from their stamps are in no run.
std::vector<SweepRun> sweep_runs(const std::vector<Scan>& scans, std::size_t first, std::size_t last, double period_s,
                                 bool goes_by_beam_times);

/// The beams of a sweep were sent at these times.
struct BeamTiming {
  double sweep_time_s = 0.0;  ///< negative where the beams are listed from last to first; 0 where all are sent at once
  bool told = false;          ///< the log states the time of each beam

  /// Returns the time of a beam after the stamp of its sweep.
  double beam_s(const Sweep& sweep, std::size_t beam) const;
};

/// Returns the scans of `run` with times counted from the stamp of its first scan, and about `max_points` points of
/// each.
std::vector<TimedSweep> timed_sweeps(const std::vector<Scan>& scans, const SweepRun& run, const BeamTiming& timing,
                                     const ReturnOptions& returns, std::size_t max_points);

/// Returns the sweep time of [first, last) that the log states, or 0 where it states none.
double told_sweep_time_s(const std::vector<Scan>& scans, std::size_t first, std::size_t last);

/// Returns the sweep time of a sensor that goes round once a period, or 0 where a scan has several sweeps of the same
/// sensor, which were not taken at the same time.
double sweep_time_of_rate_s(const std::vector<Scan>& scans, std::size_t first, std::size_t last, double period_s);

}  // namespace shapemap
