// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>

#include "shapemap/io/log_file.hpp"
#include "shapemap/scan/joined_logs.hpp"
#include "shapemap/scan/returns.hpp"

namespace shapemap {
namespace {

struct Count {
  std::size_t num_readings = 0;
  std::size_t num_returns = 0;
};

LogSummary::Sensor first_seen(const Sweep& sweep) {
  LogSummary::Sensor sensor;
  sensor.label = sweep.sensor_label;
  sensor.max_range_m = sweep.max_range_m;
  sensor.is_upside_down = is_upside_down(sweep.robot_from_sensor);
  return sensor;
}

double fov_rad(const Sweep& sweep) {
  if (sweep.is_evenly_spaced()) return std::abs(sweep.angle_step_rad) * static_cast<double>(sweep.ranges_m.size() - 1);
  const auto [lowest, highest] = std::minmax_element(sweep.beam_angles_rad.begin(), sweep.beam_angles_rad.end());
  return *highest - *lowest;
}

void add_beams(const Sweep& sweep, LogSummary::Sensor& sensor) {
  const std::size_t num_beams = sweep.ranges_m.size();
  if (num_beams == 0) {
    ++sensor.num_without_readings;
    return;
  }
  sensor.fewest_beams = sensor.most_beams == 0 ? num_beams : std::min(sensor.fewest_beams, num_beams);
  sensor.most_beams = std::max(sensor.most_beams, num_beams);
  sensor.has_uneven_beams = sensor.has_uneven_beams || !sweep.is_evenly_spaced();
  sensor.fov_rad = std::max(sensor.fov_rad, fov_rad(sweep));
  sensor.sweep_s = std::max(sensor.sweep_s, sweep.beam_time_s(num_beams - 1) - sweep.beam_time_s(0));
}

void add(const Sweep& sweep, LogSummary::Sensor& sensor, Count& count) {
  ++sensor.num_sweeps;
  add_beams(sweep, sensor);
  const std::size_t num_returns_before = count.num_returns;
  const RangeLimits limits = range_limits(sweep, ReturnOptions{});
  for (const float range_m : sweep.ranges_m) {
    ++count.num_readings;
    if (!is_return(range_m, limits)) continue;
    const double hit_m = range_m;
    sensor.shortest_return_m = count.num_returns > 0 ? std::min(sensor.shortest_return_m, hit_m) : hit_m;
    sensor.longest_return_m = std::max(sensor.longest_return_m, hit_m);
    ++count.num_returns;
  }
  if (!sweep.ranges_m.empty() && count.num_returns == num_returns_before) ++sensor.num_without_returns;
}

}  // namespace

LogSummary summarise(const Log& log) { return summarise(log, 0, log.scans.size()); }

LogSummary summarise(const Log& log, std::size_t first, std::size_t last) {
  LogSummary summary;
  summary.format = log.format;
  summary.num_scans = last - first;
  if (first == last) return summary;
  const auto begin = log.scans.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = log.scans.begin() + static_cast<std::ptrdiff_t>(last);
  const auto [earliest, latest] =
      std::minmax_element(begin, end, [](const Scan& a, const Scan& b) { return a.timestamp_s < b.timestamp_s; });
  summary.duration_s = latest->timestamp_s - earliest->timestamp_s;
  for (const NoReturnLevel& level : log.no_returns) {
    if (part_with(log, first) <= level.log && level.log <= part_with(log, last - 1))
      summary.no_returns.push_back(level);
  }
  std::vector<Count> counts;
  std::map<std::string, std::size_t, std::less<>> index_of_label;  // a damaged log may have a label for each scan
  for (auto scan = begin; scan != end; ++scan) {
    for (const Sweep& sweep : scan->sweeps) {
      const auto [known, is_new] = index_of_label.try_emplace(sweep.sensor_label, summary.sensors.size());
      const std::size_t index = known->second;
      if (is_new) {
        summary.sensors.push_back(first_seen(sweep));
        counts.emplace_back();
      }
      add(sweep, summary.sensors[index], counts[index]);
    }
  }
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i].num_readings == 0) continue;
    summary.sensors[i].return_ratio =
        static_cast<double>(counts[i].num_returns) / static_cast<double>(counts[i].num_readings);
  }
  return summary;
}

}  // namespace shapemap
