// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/core/execution.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

/// A rolling laser sends its beams one after the other while the robot moves, which bends each sweep. Deskewing
/// straightens sweeps by the motion that the sweeps themselves reveal, without odometry.
namespace shapemap {

enum class Deskew {
  kAuto,  ///< where scans then match better
  kOff,
  kOn,  ///< wherever the motion can be estimated
};

template <>
struct EnumNames<Deskew> {
  static constexpr std::array<std::string_view, 3> names{"auto", "off", "on"};
};

struct DeskewOptions {
  Deskew mode = Deskew::kAuto;
  double sweep_time_s = 0.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"deskew",
                "straighten sweeps that were bent by motion: auto where that makes scans go together better, off, on"},
          self.mode);
    visit(Field{"sweep-time",
                "seconds that a sweep takes, negative where its beams are listed from last to first; 0: as the log "
                "says, else by the rate of the scans",
                -10, 10},
          self.sweep_time_s);
  }
};

/// A verdict tells what deskewing did to the sweeps of one session.
struct SweepVerdict {
  bool straightened = false;
  double period_s = 0.0;            ///< time from one sweep to the next
  double sweep_time_s = 0.0;        ///< sweep time that was used for straightening; 0 is none
  bool told = false;                ///< the log states the times of the beams
  std::size_t num_judged = 0;       ///< stretches of fast turning that were tried with and without straightening
  std::size_t num_better = 0;       ///< number of these stretches that match better when straightened
  double misfit_before_m = 0.0;     ///< misfit of successive scans on these stretches, as recorded
  double misfit_after_m = 0.0;      ///< misfit after straightening
  std::size_t num_sweeps = 0;       ///< number of straightened sweeps
  std::size_t num_left = 0;         ///< number of sweeps whose motion could not be estimated
  std::size_t num_beams_twice = 0;  ///< beams left out where a sweep went round more than once
  std::string text;                 ///< one line for people
};

/// Straightening gives the log, and a verdict on each of its sessions.
struct StraightenedLog {
  Log log;
  std::vector<SweepVerdict> verdicts;  ///< in the order of the sessions
};

/// Returns the log with its sweeps as if all beams of a sweep had been sent at its stamp. A session is returned bit for
/// bit where there is nothing to straighten: stamps that say nothing, scans that are far apart, a robot that stands.
/// The log holds only every n-th scan of its recording, n being `every`, so that a laser goes round n times from one
/// scan to the next. This works on whole recordings by its nature, for the motion of a sweep is known only from the
/// sweeps after it, and the rate of the laser from all of them: hence a log and not its scans one by one. The same
/// input and options give the same bits for any number of threads. Throws Interrupted when the observer asks to stop.
StraightenedLog straightened(Log log, const ReturnOptions& returns, const DeskewOptions& options, int every,
                             const Execution& execution);

}  // namespace shapemap
