// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_trial.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shapemap/core/errors.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "sweep_motion.hpp"

namespace shapemap {
namespace {

/// Stretches have so many sweeps and do not overlap; so many of them are examined, and so many of these judged.
constexpr std::size_t kStretch = 4;
constexpr std::size_t kExamined = 48;
constexpr std::size_t kJudged = 24;
constexpr std::size_t kFirstJudged = 8;   ///< these show whether the rest is worth the effort
constexpr std::size_t kLeastJudged = 13;  ///< fewer could not be sure of anything by kError
constexpr std::size_t kPoints = 120;

/// A stretch tells something of the sweep time where the robot turns by this from one sweep to the next.
constexpr double kFast_rad = 2.0 * kDegree;
/// Scans with a larger misfit show places that differ too much.
constexpr double kWorstMisfit_m = 0.10;

/// The verdict "better" is wrong this often where the times of the beams do not matter.
constexpr double kError = 1e-3;

std::vector<SweepRun> stretches_of(const std::vector<SweepRun>& runs) {
  std::vector<SweepRun> all;
  for (const SweepRun& run : runs) {
    for (std::size_t i = run.first; i + kStretch <= run.last; i += kStretch) all.push_back({i, i + kStretch});
  }
  if (all.size() <= kExamined) return all;
  std::vector<SweepRun> some;
  for (std::size_t k = 0; k < kExamined; ++k) some.push_back(all[k * all.size() / kExamined]);
  return some;
}

struct Trial {
  double misfit_m = 0.0;
  double turned_rad = 0.0;  ///< largest turn from one sweep to the next
};

Trial tried(const SweepRecording& recording, const SweepRun& stretch, const BeamTiming& timing) {
  const std::vector<TimedSweep> sweeps = timed_sweeps(recording.scans, stretch, timing, recording.returns, kPoints);
  const ShortMotion motion = short_motion(sweeps, recording.period_s);
  Trial trial;
  trial.misfit_m = motion.misfit_m;
  for (std::size_t i = 1; i < sweeps.size(); ++i) {
    const double turned_rad =
        motion.trajectory.at(sweeps[i].stamp_s).z() - motion.trajectory.at(sweeps[i - 1].stamp_s).z();
    trial.turned_rad = std::max(trial.turned_rad, std::abs(turned_rad));
  }
  return trial;
}

/// Returns the stretches with the fastest turns.
std::vector<SweepRun> fastest(const std::vector<SweepRun>& stretches, const std::vector<Trial>& trials) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    if (trials[i].turned_rad > kFast_rad && trials[i].misfit_m < kWorstMisfit_m) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return trials[a].turned_rad > trials[b].turned_rad; });
  order.resize(std::min(order.size(), kJudged));
  std::vector<SweepRun> chosen;
  for (const std::size_t i : order) chosen.push_back(stretches[i]);
  return chosen;
}

/// Each row belongs to a stretch: the misfit of its sweeps as recorded, and under each of the candidates.
using Rows = std::vector<std::vector<double>>;

std::vector<double> misfits_of(const SweepRecording& recording, const SweepRun& stretch,
                               const std::vector<BeamTiming>& candidates) {
  std::vector<double> row{tried(recording, stretch, {}).misfit_m};
  for (const BeamTiming& candidate : candidates) {
    row.push_back(tried(recording, stretch, candidate).misfit_m);
  }
  return row;
}

/// Returns the number of rows in which column `a` is less than column `b`.
std::size_t num_less(const Rows& rows, std::size_t a, std::size_t b) {
  return static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [&](const auto& row) { return row[a] < row[b]; }));
}

/// Returns by how much column `b` is less than column `a`, row by row.
std::vector<double> gains_of(const Rows& rows, std::size_t a, std::size_t b) {
  std::vector<double> gains;
  for (const auto& row : rows) gains.push_back(row[a] - row[b]);
  return gains;
}

double mean_of(const Rows& rows, std::size_t column) {
  double sum = 0.0;
  for (const auto& row : rows) sum += row[column];
  return sum / std::max<double>(1.0, static_cast<double>(rows.size()));
}

/// Says whether any candidate is better in the mean; if not, no verdict for it is to be expected.
bool promises_something(const Rows& rows) {
  for (std::size_t c = 1; c < rows.front().size(); ++c) {
    if (mean_of(rows, c) < mean_of(rows, 0)) return true;
  }
  return false;
}

}  // namespace

double chance_of_gains(const std::vector<double>& gains) {
  std::vector<double> sizes;
  for (const double gain : gains) {
    if (gain != 0.0) sizes.push_back(std::abs(gain));
  }
  std::sort(sizes.begin(), sizes.end());
  // Ranks are doubled, so that equal sizes, which share their mean rank, have whole numbers.
  const auto rank_of = [&](double size) {
    const auto [low, high] = std::equal_range(sizes.begin(), sizes.end(), size);
    return static_cast<std::size_t>((low - sizes.begin()) + (high - sizes.begin()) + 1);
  };
  std::size_t reached = 0;
  std::size_t most = 0;
  std::vector<double> chance{1.0};  // of each sum of ranks
  for (const double gain : gains) {
    if (gain == 0.0) continue;
    const std::size_t rank = rank_of(std::abs(gain));
    if (gain > 0.0) reached += rank;
    most += rank;
    chance.resize(most + 1, 0.0);
    for (std::size_t sum = most + 1; sum-- > 0;) {
      chance[sum] = 0.5 * (chance[sum] + (sum >= rank ? chance[sum - rank] : 0.0));
    }
  }
  return std::accumulate(chance.begin() + static_cast<std::ptrdiff_t>(reached), chance.end(), 0.0);
}

BeamTiming best_timing(const SweepRecording& recording, const std::vector<BeamTiming>& candidates,
                       const Execution& execution, SweepVerdict& verdict) {
  const std::vector<SweepRun> stretches = stretches_of(recording.runs);
  std::vector<Trial> trials(stretches.size());
  parallel_for(stretches.size(), execution.threads,
               [&](std::size_t i) { trials[i] = tried(recording, stretches[i], candidates.front()); });
  if (!execution.observer.keep_going()) throw Interrupted();
  const std::vector<SweepRun> judged = fastest(stretches, trials);
  verdict.num_judged = judged.size();
  const BeamTiming unless_refuted = candidates.front().told ? candidates.front() : BeamTiming{};
  if (judged.size() < kLeastJudged) return unless_refuted;

  const auto judge = [&](std::size_t first, std::size_t last, Rows& rows) {
    rows.resize(last);
    parallel_for(last - first, execution.threads,
                 [&](std::size_t i) { rows[first + i] = misfits_of(recording, judged[first + i], candidates); });
    if (!execution.observer.keep_going()) throw Interrupted();
  };
  Rows misfits_m;
  judge(0, std::min(kFirstJudged, judged.size()), misfits_m);
  if (candidates.front().told || promises_something(misfits_m)) judge(misfits_m.size(), judged.size(), misfits_m);
  std::size_t best = 1;
  for (std::size_t c = 2; c <= candidates.size(); ++c) {
    const bool is_surely_less = chance_of_gains(gains_of(misfits_m, best, c)) < kError;
    if (is_surely_less && mean_of(misfits_m, c) < mean_of(misfits_m, best)) best = c;
  }
  verdict.num_judged = misfits_m.size();
  verdict.num_better = num_less(misfits_m, best, 0);
  verdict.misfit_before_m = mean_of(misfits_m, 0);
  verdict.misfit_after_m = mean_of(misfits_m, best);
  const auto tries = static_cast<double>(candidates.size());
  if (tries * chance_of_gains(gains_of(misfits_m, 0, best)) < kError) return candidates[best - 1];
  // A timing that the log states needs no proof, but must not be proved wrong.
  return chance_of_gains(gains_of(misfits_m, best, 0)) < kError ? BeamTiming{} : unless_refuted;
}

}  // namespace shapemap
