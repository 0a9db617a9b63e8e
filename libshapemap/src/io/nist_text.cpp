// SPDX-License-Identifier: GPL-3.0-or-later
#include "nist_text.hpp"

#include <map>
#include <utility>

#include "nist_scan.hpp"
#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

void expect_end(Words& words, const LineReader& lines) {
  const std::string_view word = words.next();
  if (!word.empty()) throw lines.error("unexpected '" + std::string(word) + "'");
}

std::string_view without_remark(std::string_view line) { return line.substr(0, line.find('#')); }

class NistReader {
 public:
  NistReader(ByteSource& source, const LogReadOptions& options)
      : source_(source), lines_(source), choice_(options.sensor_label) {
    log_.format = "nist";
  }

  Log read() {
    while (const std::optional<std::string_view> line = lines_.next()) {
      Words words(without_remark(*line));
      const std::string_view keyword = words.next();
      if (!keyword.empty()) read_statement(keyword, words);
    }
    drop_empty_scans();
    choice_.report(source_.path(), log_);
    warn_of_oddities();
    finish_log(source_, log_);
    return std::move(log_);
  }

 private:
  void read_statement(std::string_view keyword, Words& words) {
    if (!has_header_) return read_header(keyword, words);
    if (keyword == "units") return read_units(words);
    if (keyword == "sensor") return read_sensor(words);
    if (keyword == "position") return read_scan(words);
    if (keyword == "scan") return read_sweep(words);
    throw lines_.error("'" + std::string(keyword) + "' is no statement; expected units, sensor, position or scan");
  }

  void read_header(std::string_view keyword, Words& words) {
    if (keyword != kNistName) {
      throw lines_.error("'" + std::string(keyword) + "' where 'shapemap-scans 1' should be");
    }
    const std::string_view version = words.next();
    const std::optional<long long> number = parse_count(version);
    if (!number || *number < 1 || *number > kNistVersion) {
      throw lines_.error("version '" + std::string(version) + "' of shapemap-scans cannot be read, expected 1 or 2");
    }
    expect_end(words, lines_);
    has_header_ = true;
  }

  void read_units(Words& words) {
    if (!sensors_.empty() || !log_.scans.empty()) {
      throw lines_.error("units must come before the first sensor and position");
    }
    const std::string_view length = words.next();
    const std::string_view angle = words.next();
    if (length == "m")
      units_.metres_per_unit = 1.0;
    else if (length == "cm")
      units_.metres_per_unit = 0.01;
    else if (length == "mm")
      units_.metres_per_unit = 0.001;
    else
      throw lines_.error("unit of length is '" + std::string(length) + "', expected m, cm or mm");
    if (angle == "deg")
      units_.radians_per_unit = kDegree;
    else if (angle == "rad")
      units_.radians_per_unit = 1.0;
    else
      throw lines_.error("unit of angle is '" + std::string(angle) + "', expected deg or rad");
    expect_end(words, lines_);
    log_.states_range_unit = true;
  }

  double number(Words& words, const char* what) {
    const std::string_view word = words.next();
    if (word.empty()) throw lines_.error(std::string("too few values: ") + what + " is missing");
    return lines_.finite(word, what);
  }

  void read_sensor(Words& words) {
    NistHeader sensor = read_nist_sensor(words, lines_, units_);
    const std::string name = sensor.sweep.sensor_label;
    lines_.refuse(implausibility(sensor.sweep));
    lines_.refuse(implausible_count(sensors_.size(), "sensors"));
    if (!sensors_.emplace(name, std::move(sensor)).second) {
      throw lines_.error("sensor '" + name + "' is declared twice");
    }
  }

  void read_scan(Words& words) {
    Scan scan;
    scan.timestamp_s = number(words, "the timestamp");
    lines_.refuse(implausible_time(scan.timestamp_s));
    lines_.refuse(implausible_count(log_.scans.size(), "positions"));
    const std::string_view field = words.next();
    if (field == "reference") {
      Pose2 pose;
      pose.x_m = number(words, "reference") * units_.metres_per_unit;
      pose.y_m = number(words, "reference") * units_.metres_per_unit;
      pose.theta_rad = number(words, "reference") * units_.radians_per_unit;
      lines_.refuse(implausibility(pose));
      scan.reference_pose = pose;
    } else if (!field.empty()) {
      throw lines_.error("unexpected '" + std::string(field) + "', expected 'reference' or nothing");
    }
    expect_end(words, lines_);
    log_.scans.push_back(std::move(scan));
  }

  void read_sweep(Words& words) {
    const std::string name(words.next());
    const auto sensor = sensors_.find(name);
    if (sensor == sensors_.end()) throw lines_.error("sensor '" + name + "' is not declared above");
    if (log_.scans.empty()) throw lines_.error("a scan before the first position");
    Sweep sweep = read_nist_sweep(words, lines_, units_, sensor->second, oddities_);
    lines_.require_plausible(sweep);
    if (choice_.takes(name, false)) log_.scans.back().sweeps.push_back(std::move(sweep));
  }

  void warn_of_oddities() {
    const auto warn = [&](std::size_t count, const char* what) {
      if (count > 0) log_.warnings.push_back(source_.path() + ": " + std::to_string(count) + " scans " + what);
    };
    warn(oddities_.num_by_step, "have an angle_step and a last_angle that contradict each other; the step is used");
    warn(oddities_.num_by_limits, "have an angle_step that cannot be; first and last angle are used");
    warn(oddities_.num_without, "have angles that cannot be, and are left without readings");
  }

  /// Drops scans that were announced but have no sweep, because their laser was not asked for or the file ends.
  void drop_empty_scans() {
    std::vector<Scan> kept;
    for (Scan& scan : log_.scans) {
      if (!scan.sweeps.empty()) kept.push_back(std::move(scan));
    }
    log_.scans = std::move(kept);
  }

  ByteSource& source_;
  LineReader lines_;
  LaserChoice choice_;
  Log log_;
  bool has_header_ = false;
  NistUnits units_;
  std::map<std::string, NistHeader, std::less<>> sensors_;
  NistOddities oddities_;
};

bool begins_with_number(ByteSource& source) {
  constexpr std::size_t kPeekedBytes = 1U << 16U;
  source.ensure(kPeekedBytes);
  std::string_view content = source.buffered();
  while (!content.empty()) {
    const std::string_view line = content.substr(0, content.find('\n'));
    Words words(without_remark(line), ',');
    const std::string_view first = words.next();
    if (!first.empty()) return parse_range(first, 1.0).has_value();
    content.remove_prefix(std::min(content.size(), line.size() + 1));
  }
  return false;
}

}  // namespace

Log read_nist(ByteSource& source, const LogReadOptions& options) {
  return begins_with_number(source) ? read_bare(source, options) : NistReader(source, options).read();
}

}  // namespace shapemap
