// SPDX-License-Identifier: GPL-3.0-or-later
#include "nist_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace shapemap {
namespace {

constexpr std::array<std::string_view, 4> kLists{"angles", "times", "ranges", "intensities"};

bool is_list(std::string_view word) { return std::find(kLists.begin(), kLists.end(), word) != kLists.end(); }

class FieldReader {
 public:
  FieldReader(Words& words, const LineReader& lines, const NistUnits& units)
      : words_(words), lines_(lines), units_(units) {}

  /// Reads a field that a sensor or a scan may have; returns false when `field` is none.
  bool read_shared(std::string_view field, NistHeader& header) {
    Sweep& sweep = header.sweep;
    if (field == "first_angle") {
      header.angles.first_rad = any_number("first_angle") * units_.radians_per_unit;
      header.has_own_angles = true;
    } else if (field == "angle_step") {
      header.angles.step_rad = any_number("angle_step") * units_.radians_per_unit;
      header.has_own_angles = true;
    } else if (field == "last_angle") {
      header.angles.last_rad = any_number("last_angle") * units_.radians_per_unit;
      header.has_own_angles = true;
    } else if (field == "max_range") {
      sweep.max_range_m = positive_or_unknown(any_number("max_range") * units_.metres_per_unit);
    } else if (field == "min_range") {
      sweep.min_range_m = positive_or_unknown(any_number("min_range") * units_.metres_per_unit);
    } else if (field == "time_step") {
      sweep.beam_time_step_s = positive_or_unknown(any_number("time_step"));
    } else {
      return false;
    }
    return true;
  }

  void read_mount(MountPose& mount) {
    for (double* value : {&mount.x_m, &mount.y_m, &mount.z_m}) *value = number("mount") * units_.metres_per_unit;
    for (double* value : {&mount.yaw_rad, &mount.pitch_rad, &mount.roll_rad}) *value = angle_rad("mount");
  }

  double angle_rad(const char* what) { return number(what) * units_.radians_per_unit; }

  double number(const char* what) {
    const double value = any_number(what);
    if (!std::isfinite(value)) throw lines_.error(not_a_number(what, last_));
    return value;
  }

  /// Reads the numbers up to the next list, or the end of the line.
  std::vector<double> list(const std::string& what, double unit) {
    std::vector<double> values;
    std::string_view word = words_.next();
    for (; !word.empty() && !is_list(word); word = words_.next()) {
      const std::optional<double> value = parse_number(word);
      if (!value)
        throw lines_.error(what + " " + std::to_string(values.size() + 1) + " is '" + std::string(word) + "'");
      values.push_back(*value * unit);
    }
    after_list_ = word;
    return values;
  }

  std::vector<double> finite_list(const std::string& what, double unit) {
    std::vector<double> values = list(what, unit);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) throw lines_.error(what + " " + std::to_string(i + 1) + " is no finite number");
    }
    return values;
  }

  std::vector<float> ranges_m() {
    std::vector<float> ranges_m;
    std::string_view word = words_.next();
    for (; !word.empty() && !is_list(word); word = words_.next()) {
      const std::optional<float> range_m = parse_range(word, units_.metres_per_unit);
      if (!range_m) {
        throw lines_.error("reading " + std::to_string(ranges_m.size() + 1) + " is '" + std::string(word) + "'");
      }
      ranges_m.push_back(*range_m);
    }
    after_list_ = word;
    return ranges_m;
  }

  /// Returns the keyword that ended the last list; empty at the end of the line.
  std::string_view after_list() const { return after_list_; }

 private:
  static std::string not_a_number(const char* what, std::string_view word) {
    return std::string(what) + " is '" + std::string(word) + "', expected a number";
  }

  static double positive_or_unknown(double value) { return std::isfinite(value) && value > 0.0 ? value : 0.0; }

  /// Accepts also `nan` and `inf`, which headers hold where a driver does not know.
  double any_number(const char* what) {
    last_ = words_.next();
    if (last_.empty()) throw lines_.error("too few values: " + std::string(what) + " is missing");
    const std::optional<double> value = parse_number(last_);
    if (!value) throw lines_.error(not_a_number(what, last_));
    return *value;
  }

  Words& words_;
  const LineReader& lines_;
  const NistUnits& units_;
  std::string_view last_;
  std::string_view after_list_;
};

std::optional<std::size_t> read_num_beams(Words& words, const LineReader& lines) {
  const std::string_view word = words.next();
  if (word == "any") return std::nullopt;
  const std::optional<long long> count = parse_count(word);
  if (!count || *count < 1) {
    throw lines.error("beams is '" + std::string(word) + "', expected 1 or more, or 'any'");
  }
  return static_cast<std::size_t>(*count);
}

/// A `scan` line may have these lists.
struct Lists {
  bool has_angles = false;
  bool has_times = false;
  bool has_intensities = false;
  std::vector<double> angles_rad;
  std::vector<double> times_s;
  std::vector<double> intensities;
};

void require_as_many(std::size_t count, const char* what, const Sweep& sweep, const LineReader& lines) {
  if (count == sweep.ranges_m.size()) return;
  throw lines.error(std::to_string(count) + " " + what + " for " + std::to_string(sweep.ranges_m.size()) + " readings");
}

void check_num_readings(const NistHeader& sensor, const Sweep& sweep, const LineReader& lines) {
  const std::size_t num_values = sweep.ranges_m.size();
  if (!sensor.num_beams || num_values == *sensor.num_beams) return;
  throw lines.error((num_values < *sensor.num_beams ? "too few values: " : "too many values: ") +
                    std::to_string(num_values) + " readings, but sensor '" + sweep.sensor_label + "' has " +
                    std::to_string(*sensor.num_beams) + " beams");
}

void set_even_angles(const NistHeader& header, Sweep& sweep, const LineReader& lines, NistOddities& oddities) {
  const std::optional<EvenBeams> beams = even_beams(header.angles, sweep.ranges_m.size());
  if (!beams && header.has_own_angles) {
    ++oddities.num_without;
    for (auto* readings : {&sweep.ranges_m, &sweep.beam_times_s, &sweep.intensities}) readings->clear();
    return;
  }
  if (!beams) {
    throw lines.error("neither angle_step nor last_angle says where the " + std::to_string(sweep.ranges_m.size()) +
                      " beams point, expected a step that is not 0 and at most a full turn");
  }
  sweep.first_angle_rad = beams->first_rad;
  sweep.angle_step_rad = beams->step_rad;
  if (beams->source == AngleSource::kStep) ++oddities.num_by_step;
  if (beams->source == AngleSource::kLimits) ++oddities.num_by_limits;
}

void set_lists(const Lists& lists, Sweep& sweep, const LineReader& lines) {
  if (lists.has_times) {
    require_as_many(lists.times_s.size(), "times", sweep, lines);
    sweep.beam_times_s.assign(lists.times_s.begin(), lists.times_s.end());
  }
  if (lists.has_intensities) {
    require_as_many(lists.intensities.size(), "intensities", sweep, lines);
    sweep.intensities.assign(lists.intensities.begin(), lists.intensities.end());
  }
  if (lists.has_angles) {
    require_as_many(lists.angles_rad.size(), "angles", sweep, lines);
    set_beam_angles(sweep, lists.angles_rad);
  }
}

}  // namespace

NistHeader read_nist_sensor(Words& words, const LineReader& lines, const NistUnits& units) {
  const std::string name(words.next());
  if (name.empty()) throw lines.error("too few values: the sensor's name is missing");
  NistHeader sensor;
  sensor.sweep.sensor_label = name;
  bool has_beams = false;
  FieldReader fields(words, lines, units);
  for (std::string_view field = words.next(); !field.empty(); field = words.next()) {
    if (field == "beams") {
      sensor.num_beams = read_num_beams(words, lines);
      has_beams = true;
    } else if (field == "mount") {
      fields.read_mount(sensor.sweep.robot_from_sensor);
    } else if (!fields.read_shared(field, sensor)) {
      throw lines.error("'" + std::string(field) +
                        "' is no field of a sensor; expected beams, first_angle, angle_step, last_angle, max_range, "
                        "min_range, time_step or mount");
    }
  }
  if (!has_beams) throw lines.error("sensor '" + name + "' has no 'beams'");
  return sensor;
}

Sweep read_nist_sweep(Words& words, const LineReader& lines, const NistUnits& units, const NistHeader& sensor,
                      NistOddities& oddities) {
  NistHeader header = sensor;
  header.has_own_angles = false;
  Sweep& sweep = header.sweep;
  FieldReader fields(words, lines, units);
  Lists lists;
  bool has_ranges = false;
  if (words.next() != "heading") throw lines.error("expected 'heading' after the sensor's name");
  sweep.nominal_heading_rad = fields.angle_rad("heading");
  for (std::string_view field = words.next(); !field.empty();) {
    if (field == "ranges") {
      sweep.ranges_m = fields.ranges_m();
      has_ranges = true;
    } else if (field == "angles") {
      lists.angles_rad = fields.finite_list("angle", units.radians_per_unit);
      lists.has_angles = true;
    } else if (field == "times") {
      lists.times_s = fields.finite_list("time", 1.0);
      lists.has_times = true;
    } else if (field == "intensities") {
      lists.intensities = fields.list("intensity", 1.0);
      lists.has_intensities = true;
    } else if (field == "time") {
      sweep.start_s = fields.number("time");
    } else if (!fields.read_shared(field, header)) {
      throw lines.error("'" + std::string(field) + "' is no field of a scan; expected 'ranges', or before it time, " +
                        "first_angle, angle_step, last_angle, max_range, min_range, time_step, angles or times");
    }
    field = is_list(field) ? fields.after_list() : words.next();
  }
  if (!has_ranges) throw lines.error("expected 'ranges' after the heading");
  check_num_readings(sensor, sweep, lines);
  set_lists(lists, sweep, lines);
  if (!lists.has_angles) set_even_angles(header, sweep, lines, oddities);
  return std::move(sweep);
}

}  // namespace shapemap
