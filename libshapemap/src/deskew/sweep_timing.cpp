// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_timing.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "sweep_points.hpp"

namespace shapemap {
namespace {

/// A longer time between two sweeps is a gap in which the motion is unknown.
constexpr double kLongestGap = 2.5;
/// Beams that are sent more periods away from the stamp are no part of a sweep.
constexpr double kOddTime = 2.0;
/// Fewer sweeps in a row do not tell how they were bent.
constexpr std::size_t kLeastSweeps = 4;

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Says whether the log states that a beam was sent long before or after its sweep, which makes its times useless.
bool has_odd_times(const Scan& scan, double period_s) {
  for (const Sweep& sweep : scan.sweeps) {
    for (std::size_t beam = 0; beam < sweep.ranges_m.size(); ++beam) {
      if (!(std::abs(sweep.beam_time_s(beam)) <= kOddTime * period_s)) return true;
    }
  }
  return false;
}

/// Returns the angle that the beams of the widest sweep go through.
double turned_rad(const Scan& scan) {
  double turned_rad = 0.0;
  for (const Sweep& sweep : scan.sweeps) {
    const std::size_t num = sweep.ranges_m.size();
    if (num < 2) continue;
    double lowest_rad = sweep.beam_angle_rad(0);
    double highest_rad = lowest_rad;
    for (std::size_t beam = 1; beam < num; ++beam) {
      lowest_rad = std::min(lowest_rad, sweep.beam_angle_rad(beam));
      highest_rad = std::max(highest_rad, sweep.beam_angle_rad(beam));
    }
    turned_rad = std::max(turned_rad, highest_rad - lowest_rad);
  }
  return turned_rad;
}

}  // namespace

double usual_period_s(const std::vector<Scan>& scans, std::size_t first, std::size_t last) {
  std::vector<double> steps_s;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double step_s = scans[i].timestamp_s - scans[i - 1].timestamp_s;
    if (!(step_s > 0.0) || !std::isfinite(step_s)) continue;
    steps_s.push_back(step_s);
  }
  // Where half of the stamps stand still or go back, they are no clock.
  if (2 * steps_s.size() < last - first) return 0.0;
  return median_of(std::move(steps_s));
}

std::vector<SweepRun> sweep_runs(const std::vector<Scan>& scans, std::size_t first, std::size_t last, double period_s,
                                 bool goes_by_beam_times) {
  const auto is_odd = [&](std::size_t i) { return goes_by_beam_times && has_odd_times(scans[i], period_s); };
  std::vector<SweepRun> runs;
  std::size_t start = first;
  for (std::size_t i = first + 1; i <= last; ++i) {
    if (i < last && !is_odd(i) && !is_odd(i - 1)) {
      const double step_s = scans[i].timestamp_s - scans[i - 1].timestamp_s;
      if (step_s > 0.0 && step_s <= kLongestGap * period_s) continue;
    }
    if (i - start >= kLeastSweeps) runs.push_back({start, i});
    start = i;
  }
  return runs;
}

double BeamTiming::beam_s(const Sweep& sweep, std::size_t beam) const {
  if (sweep_time_s == 0.0) return 0.0;
  if (told) return sweep.beam_time_s(beam);
  const double share = static_cast<double>(beam) / static_cast<double>(sweep.ranges_m.size());
  return sweep_time_s > 0.0 ? share * sweep_time_s : (share - 1.0) * sweep_time_s;
}

std::vector<TimedSweep> timed_sweeps(const std::vector<Scan>& scans, const SweepRun& run, const BeamTiming& timing,
                                     const ReturnOptions& returns, std::size_t max_points) {
  std::vector<TimedSweep> sweeps;
  sweeps.reserve(run.last - run.first);
  for (std::size_t i = run.first; i < run.last; ++i) {
    const Scan& scan = scans[i];
    TimedSweep sweep;
    sweep.stamp_s = scan.timestamp_s - scans[run.first].timestamp_s;
    sweep.first_s = sweep.stamp_s;
    sweep.last_s = sweep.stamp_s;
    std::vector<double> ranges_m;
    for (const SweepPoint& point : sweep_points(scan, returns, max_points)) {
      const double time_s = sweep.stamp_s + timing.beam_s(scan.sweeps[point.sweep], point.beam);
      sweep.points.push_back({point.p_m, time_s, point.begins_line});
      sweep.first_s = std::min(sweep.first_s, time_s);
      sweep.last_s = std::max(sweep.last_s, time_s);
      ranges_m.push_back(point.p_m.norm());
    }
    sweep.turned_rad = turned_rad(scan);
    sweep.usual_range_m = median_of(std::move(ranges_m));
    sweeps.push_back(std::move(sweep));
  }
  return sweeps;
}

double told_sweep_time_s(const std::vector<Scan>& scans, std::size_t first, std::size_t last) {
  std::vector<double> times_s;
  for (std::size_t i = first; i < last; ++i) {
    for (const Sweep& sweep : scans[i].sweeps) {
      const std::size_t num = sweep.ranges_m.size();
      if (num > 1) times_s.push_back(sweep.beam_time_s(num - 1) - sweep.beam_time_s(0));
    }
  }
  return median_of(std::move(times_s));
}

double sweep_time_of_rate_s(const std::vector<Scan>& scans, std::size_t first, std::size_t last, double period_s) {
  std::vector<double> seen_rad;
  for (std::size_t i = first; i < last; ++i) {
    std::set<std::string> labels;
    for (const Sweep& sweep : scans[i].sweeps) {
      if (!labels.insert(sweep.sensor_label).second) return 0.0;
      const std::size_t num = sweep.ranges_m.size();
      if (num < 2) continue;
      const double step_rad = std::abs(sweep.angle_step_rad);
      seen_rad.push_back(std::min(2.0 * kPi, step_rad * static_cast<double>(num)));
    }
  }
  return period_s * median_of(std::move(seen_rad)) / (2.0 * kPi);
}

}  // namespace shapemap
