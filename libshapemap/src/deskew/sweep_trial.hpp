// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/observer.hpp"
#include "shapemap/deskew/deskew.hpp"
#include "sweep_timing.hpp"

namespace shapemap {

/// Tries `candidates` on stretches of `runs` where the robot turns fast, each as a time that a sweep may take; the
/// first is the likeliest. The one by which successive scans go together best, if that is no chance; else what the log
/// tells, if it is the first and not worse than nothing; else a timing with sweep_time_s 0. What was seen goes into
/// `verdict`.
BeamTiming best_timing(const Log& log, const std::vector<SweepRun>& runs, double period_s,
                       const std::vector<BeamTiming>& candidates, const ReturnOptions& returns, int threads,
                       RunObserver& observer, SweepVerdict& verdict);

/// Probability of gains as high as these, all in all, where gains and losses are equally likely: Wilcoxon's signed-rank
/// test, one-sided and exact.
double chance_of_gains(const std::vector<double>& gains);

}  // namespace shapemap
