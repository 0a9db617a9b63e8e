// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/deskew/deskew.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "shapemap/core/errors.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/scan/joined_logs.hpp"
#include "sweep_motion.hpp"
#include "sweep_timing.hpp"
#include "sweep_trial.hpp"
#include "sweep_unbending.hpp"

namespace shapemap {
namespace {

/// No laser goes round more slowly. Scans that are farther apart were picked, and logs without a clock count seconds.
constexpr double kLongestPeriod_s = 0.6;

/// No laser goes round faster, so that such stamps are in another unit.
constexpr double kShortestPeriod_s = 0.002;

/// Sensors that are read less often than they go round, or that rest in between, need only such shares of their period.
constexpr std::array<double, 4> kShares{0.75, 0.5, 1.0 / 3.0, 0.25};

/// The motion of a sweep is estimated from so many points.
constexpr std::size_t kPoints = 360;

/// A sweep whose points move less than this is straight already.
constexpr double kStraight_m = 0.005;
/// A sweep that matches its neighbours no better than this has an unknown motion.
constexpr double kUnknownMotion_m = 0.15;

/// A sweep time that a log states is believed within these shares of the period.
constexpr double kShortestTold = 0.02;
constexpr double kLongestTold = 1.05;

std::string seconds_text(double seconds) {
  std::ostringstream stream;
  stream.precision(3);
  stream << seconds << " s";
  return stream.str();
}

/// All sessions of a call of straightened() share this task.
struct Task {
  const ReturnOptions& returns;
  const DeskewOptions& options;
  int every;  ///< turns of the laser from one scan to the next
  const Execution& execution;
};

class SessionDeskew {
 public:
  SessionDeskew(const Task& task, const LogPart& part, std::vector<Scan>& scans)
      : scans_(scans),
        part_(part),
        returns_(task.returns),
        options_(task.options),
        every_(task.every),
        execution_(task.execution),
        observer_(task.execution.observer) {}

  SweepVerdict straighten() {
    verdict_.period_s = usual_period_s(scans_, part_.first, part_.last);
    if (!(verdict_.period_s >= kShortestPeriod_s && verdict_.period_s <= kLongestPeriod_s)) return verdict_;
    const double told_s = told_sweep_time_s(scans_, part_.first, part_.last);
    const std::vector<SweepRun> runs =
        sweep_runs(scans_, part_.first, part_.last, verdict_.period_s, is_possible(told_s));
    if (told_s != 0.0 && !is_possible(told_s)) {
      observer_.on_warning("the log says that a sweep takes " + seconds_text(told_s) + ", but sweeps are " +
                           seconds_text(turn_s()) + " apart; that is not used");
    }
    const BeamTiming timing = timing_of(runs, told_s);
    if (timing.sweep_time_s == 0.0) return verdict_;
    verdict_.straightened = true;
    verdict_.sweep_time_s = timing.sweep_time_s;
    verdict_.told = timing.told;
    for (const SweepRun& run : runs) straighten_run(run, timing);
    verdict_.text = "sweeps of " + seconds_text(std::abs(timing.sweep_time_s)) + " straightened";
    if (verdict_.num_judged > 0) {
      std::ostringstream share;
      share.precision(3);
      share << 100.0 * static_cast<double>(verdict_.num_better) / static_cast<double>(verdict_.num_judged);
      verdict_.text += ": " + share.str() + " % of fast turns go together better";
    }
    return verdict_;
  }

 private:
  /// Returns the time in which the laser goes round once.
  double turn_s() const { return verdict_.period_s / every_; }

  bool is_possible(double told_s) const {
    const double share = std::abs(told_s) / turn_s();
    return share >= kShortestTold && share <= kLongestTold;
  }

  BeamTiming timing_of(const std::vector<SweepRun>& runs, double told_s) {
    if (options_.sweep_time_s != 0.0) return {options_.sweep_time_s, false};
    std::vector<BeamTiming> candidates;
    if (is_possible(told_s)) candidates.push_back({told_s, true});
    const double round_s = sweep_time_of_rate_s(scans_, part_.first, part_.last, turn_s());
    if (round_s > 0.0) {
      candidates.push_back({round_s, false});
      for (const double share : kShares) candidates.push_back({share * round_s, false});
      candidates.push_back({-round_s, false});
    }
    if (candidates.empty() || runs.empty()) return {};
    if (options_.mode == Deskew::kOn) return candidates.front();
    const SweepRecording recording{scans_, runs, verdict_.period_s, returns_};
    const BeamTiming best = best_timing(recording, candidates, execution_, verdict_);
    if (candidates.front().told && !best.told) {
      observer_.on_warning("by what the log says, a sweep takes " + seconds_text(told_s) + ", but scans go together " +
                           (best.sweep_time_s == 0.0 ? "worse for it" : "better by another time") +
                           "; that is not used");
    }
    return best;
  }

  void straighten_run(const SweepRun& run, const BeamTiming& timing) {
    const std::vector<TimedSweep> sweeps = timed_sweeps(scans_, run, timing, returns_, kPoints);
    const SweepMotion motion = sweep_motion(sweeps, verdict_.period_s, execution_.threads, [&](std::size_t done) {
      observer_.on_progress(run.first - part_.first + done, part_.last - part_.first);
      return observer_.keep_going();
    });
    std::vector<SweepVerdict> parts(sweeps.size());
    parallel_for(sweeps.size(), execution_.threads, [&](std::size_t i) {
      const double next_m = i + 1 < sweeps.size() ? motion.misfit_m[i + 1] : motion.misfit_m[i];
      const double before_m = i > 0 ? motion.misfit_m[i] : next_m;
      if (std::min(before_m, next_m) > kUnknownMotion_m) {
        parts[i].num_left = 1;
        return;
      }
      straighten_scan(sweeps[i].stamp_s, motion.trajectory, timing, scans_[run.first + i], parts[i]);
    });
    for (const SweepVerdict& part : parts) {
      verdict_.num_sweeps += part.num_sweeps;
      verdict_.num_left += part.num_left;
      verdict_.num_beams_twice += part.num_beams_twice;
    }
  }

  void straighten_scan(double stamp_s, const SweepTrajectory& trajectory, const BeamTiming& timing, Scan& scan,
                       SweepVerdict& verdict) const {
    const Pose2 stamp_from_map = inverse(trajectory.pose_at(stamp_s));
    const auto motion_of = [&](const Sweep& sweep) {
      return
          [&](std::size_t beam) { return stamp_from_map * trajectory.pose_at(stamp_s + timing.beam_s(sweep, beam)); };
    };
    double bent_m = 0.0;
    for (const Sweep& sweep : scan.sweeps) {
      bent_m = std::max(bent_m, most_bent_m(sweep, returns_, motion_of(sweep)));
    }
    if (bent_m < kStraight_m) return;
    for (Sweep& sweep : scan.sweeps) {
      Sweep straight = unbent(sweep, returns_, motion_of(sweep));
      verdict.num_beams_twice += sweep.ranges_m.size() - straight.ranges_m.size();
      sweep = std::move(straight);
    }
    verdict.num_sweeps = 1;
  }

  std::vector<Scan>& scans_;  ///< those of all sessions
  LogPart part_;
  const ReturnOptions& returns_;
  const DeskewOptions& options_;
  int every_;
  const Execution& execution_;
  RunObserver& observer_;
  SweepVerdict verdict_;
};

}  // namespace

StraightenedLog straightened(Log log, const ReturnOptions& returns, const DeskewOptions& options, int every,
                             const Execution& execution) {
  StraightenedLog result{std::move(log), {}};
  if (options.mode != Deskew::kOff) execution.observer.on_stage("sweeps");
  const Task task{returns, options, every, execution};
  for (const LogPart& part : parts_of(result.log)) {
    result.verdicts.emplace_back();
    if (options.mode == Deskew::kOff) continue;
    result.verdicts.back() = SessionDeskew(task, part, result.log.scans).straighten();
  }
  return result;
}

}  // namespace shapemap
