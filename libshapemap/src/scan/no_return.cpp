// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/no_return.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "level_extent.hpp"
#include "level_test.hpp"
#include "range_order.hpp"
#include "range_sample.hpp"
#include "shapemap/scan/returns.hpp"

namespace shapemap {
namespace {

constexpr std::size_t kMostLevels = 32;        // of one sensor; each costs a round of the test
constexpr std::size_t kFewSweeps = 64;         // sensors with fewer are examined together
constexpr std::size_t kTooFewSweeps = 12;      // so few independent views cannot be sure of anything by themselves
constexpr double kFarBeyondHeader = 1.1;       // readings just beyond a maximum may be noise, or the maximum itself
constexpr double kFewestBeyondHeader = 0.005;  // as a share of all readings
// readings nearer to a level, as a share of its distance, may be odd readings of it
constexpr double kApartOfLevel = 0.02;
constexpr Millimetres kNowhere_mm = std::numeric_limits<Millimetres>::max();

/// SICK lasers count up to 8182 in units of 1 cm or 4 mm; 8183 to 8191 are error codes. Logs that are too short for a
/// test are believed to have these known codes, if nothing longer is in them.
constexpr std::array<LevelExtent, 2> kSickCodes{{{81825, 81915}, {32730, 32770}}};
constexpr std::size_t kTimesMoreThanBelow = 5;

using Sweeps = std::vector<Sweep*>;

struct Sensor {
  std::string label;
  Sweeps sweeps;
  std::vector<LevelExtent> levels;
};

std::vector<Sensor> sensors_of(Log& log) {
  std::vector<Sensor> sensors;
  std::map<std::string, std::size_t> known;
  for (Scan& scan : log.scans) {
    for (Sweep& sweep : scan.sweeps) {
      const auto [at, is_new] = known.emplace(sweep.sensor_label, sensors.size());
      if (is_new) sensors.push_back({sweep.sensor_label, {}, {}});
      sensors[at->second].sweeps.push_back(&sweep);
    }
  }
  return sensors;
}

std::vector<LevelExtent> merged(std::vector<LevelExtent> levels, Millimetres gap_mm) {
  std::sort(levels.begin(), levels.end(), [](const auto& a, const auto& b) { return a.from_mm < b.from_mm; });
  std::vector<LevelExtent> all;
  for (const LevelExtent& level : levels) {
    if (!all.empty() && level.from_mm - all.back().to_mm <= gap_mm) {
      all.back().to_mm = std::max(all.back().to_mm, level.to_mm);
    } else {
      all.push_back(level);
    }
  }
  return all;
}

std::vector<LevelExtent> learned_levels(const Sweeps& sweeps) {
  RangeSample sample(sweeps);
  LevelTest test(sample);
  std::vector<LevelExtent> levels;
  while (levels.size() < kMostLevels) {
    const std::optional<LevelWindow> window = test.next();
    if (!window) break;
    levels.push_back(extent_of(sweeps, *window, test.resolution_mm()));
    sample.remove(levels.back().from_mm, levels.back().to_mm);
  }
  return merged(std::move(levels), test.resolution_mm());
}

void learn_levels(std::vector<Sensor>& sensors) {
  std::vector<Sensor*> few;
  Sweeps together;
  for (Sensor& sensor : sensors) {
    if (sensors.size() == 1 || sensor.sweeps.size() >= kTooFewSweeps) sensor.levels = learned_levels(sensor.sweeps);
    if (!sensor.levels.empty() || sensor.sweeps.size() >= kFewSweeps) continue;
    few.push_back(&sensor);
    together.insert(together.end(), sensor.sweeps.begin(), sensor.sweeps.end());
  }
  if (few.size() < 2) return;
  const std::vector<LevelExtent> levels = learned_levels(together);
  for (Sensor* sensor : few) sensor->levels = levels;
}

/// Returns the start of the lowest level with no surfaces beyond it.
Millimetres top_of(const Sensor& sensor) {
  Millimetres top_mm = kNowhere_mm;
  for (auto level = sensor.levels.rbegin(); level != sensor.levels.rend(); ++level) {
    const Millimetres apart_mm =
        std::max(static_cast<Millimetres>(kApartOfLevel * level->to_mm), 3 * (level->to_mm - level->from_mm));
    if (readings_beyond(sensor.sweeps, level->to_mm + apart_mm, kNowhere_mm, sensor.levels).are_surfaces()) break;
    top_mm = level->from_mm;
  }
  return top_mm;
}

/// Drops the maximum ranges of headers that surfaces lie far beyond.
void give_up_wrong_maxima(const Sensor& sensor, Millimetres top_mm, std::vector<std::string>& warnings) {
  std::map<double, Sweeps> by_maximum;
  for (Sweep* sweep : sensor.sweeps) {
    if (sweep->max_range_m > 0.0) by_maximum[sweep->max_range_m].push_back(sweep);
  }
  for (const auto& [maximum_m, sweeps] : by_maximum) {
    const double far_mm = std::min(1000.0 * kFarBeyondHeader * maximum_m, static_cast<double>(kNowhere_mm - 1));
    const FarReadings far = readings_beyond(sweeps, static_cast<Millimetres>(far_mm), top_mm, sensor.levels);
    const double fewest = kFewestBeyondHeader * static_cast<double>(far.num_all);
    if (!far.are_surfaces() || static_cast<double>(far.num_in_order) < fewest) continue;
    for (Sweep* sweep : sweeps) sweep->max_range_m = 0.0;
    char text[200];
    std::snprintf(text, sizeof text,
                  "the maximum range of %.6g m in the log is not used: %zu readings continue each other beyond it",
                  maximum_m, far.num_in_order);
    warnings.push_back((sensor.label.empty() ? "" : "laser '" + sensor.label + "': ") + text);
  }
}

void believe_sick_codes(Sensor& sensor) {
  Millimetres longest_mm = 0;
  for (const Sweep* sweep : sensor.sweeps) {
    if (sweep->max_range_m > 0.0) return;
    for (const float range_m : sweep->ranges_m) longest_mm = std::max(longest_mm, to_mm(range_m, *sweep));
  }
  for (const LevelExtent& codes : kSickCodes) {
    if (longest_mm < codes.from_mm || longest_mm > codes.to_mm) continue;
    const Millimetres width_mm = codes.to_mm - codes.from_mm;
    std::size_t on_level = 0;
    std::size_t below = 0;
    double from_m = kLongestRange_m;
    for (const Sweep* sweep : sensor.sweeps) {
      for (const float range_m : sweep->ranges_m) {
        const Millimetres range_mm = to_mm(range_m, *sweep);
        if (range_mm >= codes.from_mm) {
          ++on_level;
          from_m = std::min(from_m, static_cast<double>(range_m));
        } else if (range_mm >= codes.from_mm - width_mm) {
          ++below;
        }
      }
    }
    if (on_level <= kTimesMoreThanBelow * below) continue;
    for (Sweep* sweep : sensor.sweeps) sweep->max_range_m = from_m;
  }
}

/// Notes the readings on the levels, and makes them no returns.
void take_levels(Sensor& sensor, Millimetres top_mm, std::vector<NoReturnLevel>& noted) {
  double top_m = top_mm < kNowhere_mm ? top_mm / 1000.0 : 0.0;
  for (const LevelExtent& level : sensor.levels) {
    NoReturnLevel note{sensor.label, std::numeric_limits<double>::infinity(), 0.0, 0, 0};
    for (Sweep* sweep : sensor.sweeps) {
      for (float& range_m : sweep->ranges_m) {
        const Millimetres range_mm = to_mm(range_m, *sweep);
        if (range_mm < level.from_mm || range_mm > level.to_mm) continue;
        ++note.num_readings;
        note.from_m = std::min(note.from_m, static_cast<double>(range_m));
        note.to_m = std::max(note.to_m, static_cast<double>(range_m));
        if (level.from_mm < top_mm) range_m = std::numeric_limits<float>::quiet_NaN();
      }
    }
    if (note.num_readings == 0) continue;
    if (level.from_mm == top_mm) top_m = note.from_m;
    noted.push_back(std::move(note));
  }
  if (top_m <= 0.0) return;
  for (Sweep* sweep : sensor.sweeps) {
    if (sweep->max_range_m <= 0.0 || sweep->max_range_m > top_m) sweep->max_range_m = top_m;
  }
}

}  // namespace

void sort_out_no_returns(Log& log, const NoReturnChoice& choice) {
  if (!choice.is_learned && choice.given.empty()) return;
  std::vector<Sensor> sensors = sensors_of(log);
  if (choice.given.empty()) {
    learn_levels(sensors);
  } else {
    std::vector<LevelExtent> levels;
    for (const NoReturnChoice::Band& band : choice.given) {
      levels.push_back({static_cast<Millimetres>(std::lround(1000.0 * band.from_m)),
                        static_cast<Millimetres>(std::lround(1000.0 * band.to_m))});
    }
    for (Sensor& sensor : sensors) sensor.levels = merged(levels, 0);
  }
  for (Sensor& sensor : sensors) {
    const Millimetres top_mm = top_of(sensor);
    give_up_wrong_maxima(sensor, top_mm, log.warnings);
    take_levels(sensor, top_mm, log.no_returns);
    if (choice.given.empty()) believe_sick_codes(sensor);
  }
}

}  // namespace shapemap
