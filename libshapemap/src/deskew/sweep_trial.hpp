// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/core/execution.hpp"
#include "shapemap/deskew/deskew.hpp"
#include "sweep_timing.hpp"

namespace shapemap {

/// Timings are tried on these sweeps of one session.
struct SweepRecording {
  const std::vector<Scan>& scans;
  const std::vector<SweepRun>& runs;
  double period_s;
  const ReturnOptions& returns;
};

/// Tries `candidates` for the sweep time, the likeliest of them first, on stretches of the recording's runs where the
/// robot turns fast. Returns the candidate under which successive scans match best, if that is significant; else the
/// timing that the log states, if it is the first candidate and not worse than none; else a timing with sweep_time_s 0.
/// The misfits go into `verdict`.
BeamTiming best_timing(const SweepRecording& recording, const std::vector<BeamTiming>& candidates,
                       const Execution& execution, SweepVerdict& verdict);

/// Returns the probability of gains as high as these where gains and losses are equally likely, by the one-sided, exact
/// signed-rank test (Wilcoxon 1945).
double chance_of_gains(const std::vector<double>& gains);

}  // namespace shapemap
