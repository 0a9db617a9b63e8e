// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/range_unit.hpp"
#include "shapemap/scan/scan.hpp"

/// These functions read and write logs of all formats. Odometry and recorded poses are not even parsed.
namespace shapemap {

enum class LogFormat { kAuto, kRawlog, kCarmen, kNist };

template <>
struct EnumNames<LogFormat> {
  static constexpr std::array<std::string_view, 4> names{"auto", "rawlog", "carmen", "nist"};
};

/// These options state what a log may not state itself. The geometry is used for the bare form (one sweep of numbers a
/// line) and for CARMEN lines whose number of beams has no convention. `upside_down` turns every laser that is read.
struct LogReadOptions {
  std::string sensor_label;  ///< only this laser is read; empty: the first label found, with all sweeps of a frame
  double fov_rad = 0.0;      ///< angle from first to last beam; 0: by convention
  RangeUnit range_unit = RangeUnit::kAuto;
  bool upside_down = false;
  int sweeps_per_scan = 1;
  double sweep_turn_rad = 90 * kDegree;
  std::string no_return_m = "auto";  ///< see no_return_choice()

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"sensor-label", "use only the laser of this name"}, self.sensor_label);
    visit(Field{"fov-deg", "angle from first to last beam, where the log does not say [deg]; 0: by convention", 0, 360,
                kDegree},
          self.fov_rad);
    visit(Field{"range-unit", "unit of the ranges, where the log does not say; auto: as the readings tell"},
          self.range_unit);
    visit(Field{"upside-down", "the laser is mounted upside down, or counts its beams clockwise without saying so"},
          self.upside_down);
    visit(Field{"sub-scans", "sub-scans per position of a bare log", 1, 1000}, self.sweeps_per_scan);
    visit(Field{"sub-scan-turn-deg", "turn between the sub-scans of a bare log [deg]", -360, 360, kDegree},
          self.sweep_turn_rad);
    visit(Field{"no-return-m",
                "readings that mean no return [m]: levels or bands such as 51.15,51.0-51.2; auto: learned; none"},
          self.no_return_m);
  }
};

/// Recognises the format of the (decompressed) content of `path`. Throws InputError when nothing fits.
LogFormat recognise_log_format(const std::string& path);

/// Reads a whole log, plain or gzip-compressed. A log that is cut off gives its whole scans, and a warning that says
/// where it ends. Throws InputError, which names file and line or offset, and ConfigError for an option out of its
/// range.
Log read_log(const std::string& path, LogFormat format = LogFormat::kAuto, const LogReadOptions& options = {});

/// The odometry fields of a written log take one estimated pose per scan.
struct LogPoses {
  std::vector<Pose2> map_from_robot;
};

/// Writes `log` in `format` (gzip-compressed when `path` ends in .gz), whole or not at all. `poses` (one per scan, or
/// null) becomes the odometry. Throws OutputError.
void write_log(const Log& log, const std::string& path, LogFormat format, const LogPoses* poses = nullptr);

/// Returns one line on what `format` cannot hold of `log`, or an empty string. The points are always kept.
std::string what_is_lost(const Log& log, LogFormat format);

/// A summary tells users of a log before they map it.
struct LogSummary {
  struct Sensor {
    std::string label;
    std::size_t num_sweeps = 0;
    std::size_t fewest_beams = 0;          ///< least beams of a sweep that has readings
    std::size_t most_beams = 0;            ///< most beams of a sweep; 0: no sweep has readings
    std::size_t num_without_readings = 0;  ///< number of sweeps without readings
    std::size_t num_without_returns = 0;   ///< number of sweeps whose readings have no return
    bool has_uneven_beams = false;
    bool is_upside_down = false;
    double fov_rad = 0.0;      ///< widest angle from first to last beam
    double sweep_s = 0.0;      ///< longest time from first to last beam; 0: the log states none
    double max_range_m = 0.0;  ///< as the log states it; 0: it states none
    double shortest_return_m = 0.0;
    double longest_return_m = 0.0;
    double return_ratio = 0.0;  ///< share of readings that are returns
  };
  std::string format;
  std::size_t num_scans = 0;
  double duration_s = 0.0;
  std::vector<Sensor> sensors;
  std::vector<NoReturnLevel> no_returns;  ///< of all sessions that the scans are from
};
LogSummary summarise(const Log& log);
/// Summarises the scans [first, last) only.
LogSummary summarise(const Log& log, std::size_t first, std::size_t last);

}  // namespace shapemap
