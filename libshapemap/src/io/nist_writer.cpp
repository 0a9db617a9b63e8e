// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "log_formats.hpp"
#include "mount_pose.hpp"
#include "nist_text.hpp"

namespace shapemap {
namespace {

void append(std::string& text, double value) {
  text += ' ';
  append_number(text, value);
}

void append(std::string& text, const char* field, double value) {
  text += ' ';
  text += field;
  append(text, value);
}

/// A `sensor` statement holds what most of its sweeps have in common. A `scan` statement holds what differs.
struct Sensor {
  std::string name;
  Sweep usual;  ///< the first sweep, without readings
  std::size_t num_beams = 0;
  bool has_any_number = false;
};

/// Angles are divided by this. Degrees are for people; they do not always read back as the same radians.
double angle_unit_rad(int version) { return version == 1 ? kDegree : 1.0; }

/// Returns the fields that `sweep` does not share with `usual`; of the sensor itself, all that state something.
std::string header_text(const Sweep& sweep, const Sweep& usual, double unit_rad) {
  std::string text;
  if (sweep.is_evenly_spaced() && sweep.first_angle_rad != usual.first_angle_rad) {
    append(text, "first_angle", sweep.first_angle_rad / unit_rad);
  }
  if (sweep.is_evenly_spaced() && sweep.angle_step_rad != usual.angle_step_rad) {
    append(text, "angle_step", sweep.angle_step_rad / unit_rad);
  }
  if (sweep.max_range_m != usual.max_range_m) append(text, "max_range", sweep.max_range_m);
  if (sweep.min_range_m != usual.min_range_m) append(text, "min_range", sweep.min_range_m);
  if (sweep.beam_time_step_s != usual.beam_time_step_s) append(text, "time_step", sweep.beam_time_step_s);
  return text;
}

/// The lasers of a log as the format wants them: each has one name, without blanks and remarks.
class Sensors {
 public:
  explicit Sensors(const Log& log) {
    for (const Scan& scan : log.scans) {
      for (const Sweep& sweep : scan.sweeps) {
        const auto [known, is_new] = index_.emplace(key_of(sweep), sensors_.size());
        if (is_new) {
          declare(sweep);
        } else if (sensors_[known->second].num_beams != sweep.ranges_m.size()) {
          sensors_[known->second].has_any_number = true;
        }
      }
    }
  }

  const Sensor& of(const Sweep& sweep) const { return sensors_[index_.at(key_of(sweep))]; }

  bool have_any_number() const {
    return std::any_of(sensors_.begin(), sensors_.end(), [](const Sensor& sensor) { return sensor.has_any_number; });
  }

  std::string text(double unit_rad) const {
    std::string text;
    for (const Sensor& sensor : sensors_) {
      const bool any = sensor.has_any_number || sensor.num_beams == 0;
      text += "sensor " + sensor.name + " beams " + (any ? "any" : std::to_string(sensor.num_beams));
      append(text, "first_angle", sensor.usual.first_angle_rad / unit_rad);
      append(text, "angle_step", sensor.usual.angle_step_rad / unit_rad);
      Sweep silent = sensor.usual;
      silent.max_range_m = silent.min_range_m = silent.beam_time_step_s = 0.0;
      text += header_text(sensor.usual, silent, unit_rad);
      append_mount(text, sensor.usual.robot_from_sensor, unit_rad);
      text += '\n';
    }
    return text;
  }

 private:
  /// The sweeps of one sensor share label and mount.
  using Key = std::tuple<std::string, double, double, double, double, double, double>;
  static Key key_of(const Sweep& sweep) {
    const MountPose& mount = sweep.robot_from_sensor;
    return {sweep.sensor_label, mount.x_m, mount.y_m, mount.z_m, mount.yaw_rad, mount.pitch_rad, mount.roll_rad};
  }

  static void append_mount(std::string& text, const MountPose& mount, double unit_rad) {
    if (mount == MountPose{}) return;
    text += " mount";
    for (const double length_m : {mount.x_m, mount.y_m, mount.z_m}) append(text, length_m);
    for (const double angle_rad : {mount.yaw_rad, mount.pitch_rad, mount.roll_rad}) append(text, angle_rad / unit_rad);
  }

  void declare(const Sweep& sweep) {
    Sensor sensor;
    sensor.name = free_name(sweep.sensor_label);
    sensor.num_beams = sweep.ranges_m.size();
    sensor.has_any_number = sweep.ranges_m.empty();
    sensor.usual = sweep;
    for (auto* readings : {&sensor.usual.ranges_m, &sensor.usual.beam_times_s, &sensor.usual.intensities}) {
      readings->clear();
    }
    sensor.usual.beam_angles_rad.clear();
    sensors_.push_back(std::move(sensor));
  }

  std::string free_name(const std::string& label) {
    std::string name = label.empty() ? "laser" : label;
    for (char& c : name) {
      if (c == '#' || static_cast<unsigned char>(c) <= ' ') c = '_';
    }
    const std::string stem = name;
    for (int i = 2; !names_.insert(name).second; ++i) name = stem + "-" + std::to_string(i);
    return name;
  }

  std::vector<Sensor> sensors_;
  std::map<Key, std::size_t> index_;
  std::set<std::string> names_;
};

/// Says whether `sweep` has something that version 1 of the format cannot state.
bool needs_version_2(const Sweep& sweep, const Sensor& sensor) {
  return !sweep.is_evenly_spaced() || sweep.start_s != 0.0 || sweep.beam_time_step_s > 0.0 ||
         !sweep.beam_times_s.empty() || !sweep.intensities.empty() || !header_text(sweep, sensor.usual, 1.0).empty();
}

int version_for(const Log& log, const Sensors& sensors) {
  if (sensors.have_any_number()) return 2;
  for (const Scan& scan : log.scans) {
    for (const Sweep& sweep : scan.sweeps) {
      if (needs_version_2(sweep, sensors.of(sweep))) return 2;
    }
  }
  return 1;
}

template <class Number>
void append_list(std::string& text, const char* name, const std::vector<Number>& values) {
  if (values.empty()) return;
  text += ' ';
  text += name;
  for (const Number value : values) {
    text += ' ';
    append_number(text, value);
  }
}

void append_sweep(std::string& text, const Sweep& sweep, const Sensor& sensor, double unit_rad) {
  text += "scan " + sensor.name;
  append(text, "heading", sweep.nominal_heading_rad / unit_rad);
  if (sweep.start_s != 0.0) append(text, "time", sweep.start_s);
  text += header_text(sweep, sensor.usual, unit_rad);
  append_list(text, "angles", sweep.beam_angles_rad);
  append_list(text, "times", sweep.beam_times_s);
  text += " ranges";
  for (const float range_m : sweep.ranges_m) {
    text += ' ';
    if (std::isfinite(range_m) || range_m < 0.0F) {
      append_number(text, std::max(range_m, 0.0F));
    } else {
      text += '-';
    }
  }
  append_list(text, "intensities", sweep.intensities);
  text += '\n';
}

}  // namespace

void write_nist(const Log& log, ByteSink& sink) {
  const Sensors sensors(log);
  const int version = version_for(log, sensors);
  const double unit_rad = angle_unit_rad(version);
  sink.write(std::string(kNistName) + " " + std::to_string(version) + "\nunits m " + (version == 1 ? "deg" : "rad") +
             "\n" + sensors.text(unit_rad));
  for (const Scan& scan : log.scans) {
    std::string text = "position";
    append(text, scan.timestamp_s);
    if (scan.reference_pose) {
      append(text, "reference", scan.reference_pose->x_m);
      append(text, scan.reference_pose->y_m);
      append(text, scan.reference_pose->theta_rad / unit_rad);
    }
    text += '\n';
    for (const Sweep& sweep : scan.sweeps) append_sweep(text, sweep, sensors.of(sweep), unit_rad);
    sink.write(text);
  }
}

}  // namespace shapemap
