// SPDX-License-Identifier: GPL-3.0-or-later
#include "nist_text.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

/// What a `sensor` line declares: a sub-scan without readings.
struct Sensor {
  SubScan prototype;
  std::size_t num_beams = 0;
};

double finite_number(Words& words, const LineReader& lines, const std::string& what) {
  const std::string_view word = words.next();
  if (word.empty()) throw lines.error("too few values: " + what + " is missing");
  const std::optional<double> value = parse_number(word);
  if (!value || !std::isfinite(*value)) {
    throw lines.error(what + " is '" + std::string(word) + "', expected a number");
  }
  return *value;
}

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
    drop_empty_positions();
    choice_.report(source_.path(), log_);
    finish_log(source_, log_);
    return std::move(log_);
  }

 private:
  void read_statement(std::string_view keyword, Words& words) {
    if (!has_header_) return read_header(keyword, words);
    if (keyword == "units") return read_units(words);
    if (keyword == "sensor") return read_sensor(words);
    if (keyword == "position") return read_position(words);
    if (keyword == "scan") return read_scan(words);
    throw lines_.error("'" + std::string(keyword) + "' is no statement; expected units, sensor, position or scan");
  }

  void read_header(std::string_view keyword, Words& words) {
    if (keyword != kNistName) {
      throw lines_.error("'" + std::string(keyword) + "' where 'shapemap-scans 1' should be");
    }
    const std::string_view version = words.next();
    if (parse_count(version) != kNistVersion) {
      throw lines_.error("version '" + std::string(version) + "' of shapemap-scans cannot be read, expected 1");
    }
    expect_end(words, lines_);
    has_header_ = true;
  }

  void read_units(Words& words) {
    if (!sensors_.empty() || !log_.positions.empty()) {
      throw lines_.error("units must come before the first sensor and position");
    }
    const std::string_view length = words.next();
    const std::string_view angle = words.next();
    if (length == "m")
      metres_per_unit_ = 1.0;
    else if (length == "cm")
      metres_per_unit_ = 0.01;
    else if (length == "mm")
      metres_per_unit_ = 0.001;
    else
      throw lines_.error("unit of length is '" + std::string(length) + "', expected m, cm or mm");
    if (angle == "deg")
      radians_per_unit_ = kDegree;
    else if (angle == "rad")
      radians_per_unit_ = 1.0;
    else
      throw lines_.error("unit of angle is '" + std::string(angle) + "', expected deg or rad");
    expect_end(words, lines_);
  }

  double length_m(Words& words, const char* what) { return finite_number(words, lines_, what) * metres_per_unit_; }
  double angle_rad(Words& words, const char* what) { return finite_number(words, lines_, what) * radians_per_unit_; }

  void read_sensor(Words& words) {
    const std::string name(words.next());
    if (name.empty()) throw lines_.error("too few values: the sensor's name is missing");
    Sensor sensor;
    sensor.prototype.sensor_label = name;
    for (std::string_view field = words.next(); !field.empty(); field = words.next()) {
      read_sensor_field(field, words, sensor);
    }
    if (sensor.num_beams == 0) throw lines_.error("sensor '" + name + "' has no 'beams'");
    if (sensor.prototype.angle_step_rad == 0.0 && sensor.num_beams > 1) {
      throw lines_.error("sensor '" + name + "' has no 'angle_step', or one of 0");
    }
    lines_.refuse(implausibility(sensor.prototype, sensor.num_beams));
    lines_.refuse(implausible_count(sensors_.size(), "sensors"));
    if (!sensors_.emplace(name, sensor).second) throw lines_.error("sensor '" + name + "' is declared twice");
  }

  void read_sensor_field(std::string_view field, Words& words, Sensor& sensor) {
    SubScan& scan = sensor.prototype;
    if (field == "beams") {
      const std::string_view word = words.next();
      const std::optional<long long> count = parse_count(word);
      if (!count || *count < 1) throw lines_.error("beams is '" + std::string(word) + "', expected 1 or more");
      sensor.num_beams = static_cast<std::size_t>(*count);
    } else if (field == "first_angle") {
      scan.first_angle_rad = angle_rad(words, "first_angle");
    } else if (field == "angle_step") {
      scan.angle_step_rad = angle_rad(words, "angle_step");
    } else if (field == "max_range") {
      scan.max_range_m = length_m(words, "max_range");
    } else if (field == "min_range") {
      scan.min_range_m = length_m(words, "min_range");
    } else if (field == "mount") {
      MountPose& mount = scan.robot_from_sensor;
      for (double* value : {&mount.x_m, &mount.y_m, &mount.z_m}) *value = length_m(words, "mount");
      for (double* value : {&mount.yaw_rad, &mount.pitch_rad, &mount.roll_rad}) *value = angle_rad(words, "mount");
    } else {
      throw lines_.error("'" + std::string(field) +
                         "' is no field of a sensor; expected beams, first_angle, angle_step, max_range, min_range or "
                         "mount");
    }
  }

  void read_position(Words& words) {
    Position position;
    position.timestamp_s = finite_number(words, lines_, "the timestamp");
    lines_.refuse(implausible_time(position.timestamp_s));
    lines_.refuse(implausible_count(log_.positions.size(), "positions"));
    const std::string_view field = words.next();
    if (field == "reference") {
      Pose2 pose;
      pose.x_m = length_m(words, "reference");
      pose.y_m = length_m(words, "reference");
      pose.theta_rad = angle_rad(words, "reference");
      lines_.refuse(implausibility(pose));
      position.reference_pose = pose;
    } else if (!field.empty()) {
      throw lines_.error("unexpected '" + std::string(field) + "', expected 'reference' or nothing");
    }
    expect_end(words, lines_);
    log_.positions.push_back(std::move(position));
  }

  void read_scan(Words& words) {
    const std::string name(words.next());
    const auto sensor = sensors_.find(name);
    if (sensor == sensors_.end()) throw lines_.error("sensor '" + name + "' is not declared above");
    if (log_.positions.empty()) throw lines_.error("a scan before the first position");
    if (words.next() != "heading") throw lines_.error("expected 'heading' after the sensor's name");
    SubScan scan = sensor->second.prototype;
    scan.nominal_heading_rad = angle_rad(words, "heading");
    if (words.next() != "ranges") throw lines_.error("expected 'ranges' after the heading");
    read_ranges(words, sensor->second.num_beams, scan);
    lines_.require_plausible(scan);
    if (choice_.takes(name, false)) log_.positions.back().sub_scans.push_back(std::move(scan));
  }

  void read_ranges(Words& words, std::size_t num_beams, SubScan& scan) {
    const std::size_t num_values = words.count_left();
    if (num_values != num_beams) {
      throw lines_.error((num_values < num_beams ? "too few values: " : "too many values: ") +
                         std::to_string(num_values) + " readings, but sensor '" + scan.sensor_label + "' has " +
                         std::to_string(num_beams) + " beams");
    }
    scan.ranges_m.reserve(num_beams);
    for (std::size_t i = 0; i < num_beams; ++i) {
      const std::string_view word = words.next();
      const std::optional<float> range_m = parse_range(word, metres_per_unit_);
      if (!range_m) throw lines_.error("reading " + std::to_string(i + 1) + " is '" + std::string(word) + "'");
      scan.ranges_m.push_back(*range_m);
    }
  }

  /// A position that was announced but has no scan, be it that its laser was not asked for or that the file ends.
  void drop_empty_positions() {
    std::vector<Position> kept;
    for (Position& position : log_.positions) {
      if (!position.sub_scans.empty()) kept.push_back(std::move(position));
    }
    log_.positions = std::move(kept);
  }

  ByteSource& source_;
  LineReader lines_;
  LaserChoice choice_;
  Log log_;
  bool has_header_ = false;
  double metres_per_unit_ = 1.0;
  double radians_per_unit_ = kDegree;
  std::map<std::string, Sensor, std::less<>> sensors_;
};

bool begins_with_number(ByteSource& source) {
  constexpr std::size_t kLookAhead = 1U << 16U;
  source.ensure(kLookAhead);
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
