// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/core/observer.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

/// A rolling laser sends its beams one after the other while the robot moves, which bends each sweep. Here sweeps are
/// straightened by the motion that they tell of themselves, without odometry.
namespace shapemap {

enum class Deskew {
  kAuto,  ///< where the scans go together better for it
  kOff,
  kOn,  ///< wherever the motion can be told
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

/// What was done about the sweeps of one log.
struct SweepVerdict {
  bool straightened = false;
  double period_s = 0.0;            ///< from one sweep to the next
  double sweep_time_s = 0.0;        ///< that was taken to straighten; 0: none
  bool told = false;                ///< the log itself tells when its beams were sent
  std::size_t num_judged = 0;       ///< stretches of fast turning that were tried with and without straightening
  std::size_t num_better = 0;       ///< of these, those that went together better for it
  double misfit_before_m = 0.0;     ///< of successive scans there, as they are
  double misfit_after_m = 0.0;      ///< and straightened
  std::size_t num_sweeps = 0;       ///< that were straightened
  std::size_t num_left = 0;         ///< whose motion could not be told
  std::size_t num_beams_twice = 0;  ///< beams left out where a sweep went round more than once
  std::string text;                 ///< one line for people
};

/// The log with its sweeps as they would be if all beams of one had been sent at its stamp. A part of it is given back
/// bit for bit where there is nothing to straighten: stamps that say nothing, scans that are far apart, a robot that
/// stands. `every`: that manieth scan of the recording is there, so that a laser goes round that often from one to the
/// next. One verdict for each log that was joined. Same input and options give the same bits for any number of
/// threads. Throws Interrupted when the observer asks to stop.
Log straightened(Log log, const ReturnOptions& returns, const DeskewOptions& options, int every, int threads,
                 RunObserver& observer, std::vector<SweepVerdict>& verdicts);

}  // namespace shapemap
