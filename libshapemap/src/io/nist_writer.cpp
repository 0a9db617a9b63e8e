// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "log_formats.hpp"
#include "mount_pose.hpp"
#include "nist_text.hpp"

namespace shapemap {
namespace {

/// One `sensor` statement.
struct Sensor {
  std::string name;
  SubScan prototype;  ///< without readings
  std::size_t num_beams = 0;

  bool made(const SubScan& scan) const {
    return num_beams == scan.ranges_m.size() && prototype.sensor_label == scan.sensor_label &&
           prototype.first_angle_rad == scan.first_angle_rad && prototype.angle_step_rad == scan.angle_step_rad &&
           prototype.min_range_m == scan.min_range_m && prototype.max_range_m == scan.max_range_m &&
           prototype.robot_from_sensor == scan.robot_from_sensor;
  }
};

void append(std::string& text, const char* field, double value) {
  text += ' ';
  text += field;
  text += ' ';
  append_number(text, value);
}

void append(std::string& text, double value) {
  text += ' ';
  append_number(text, value);
}

/// The lasers of a log as the format wants them: one name per geometry, without blanks and remarks.
class Sensors {
 public:
  explicit Sensors(const Log& log) {
    for (const Position& position : log.positions) {
      for (const SubScan& scan : position.sub_scans) {
        if (find(scan) == nullptr) declare(scan);
      }
    }
  }

  const std::string& name_of(const SubScan& scan) const { return find(scan)->name; }

  std::string text() const {
    std::string text;
    for (const Sensor& sensor : sensors_) {
      const SubScan& scan = sensor.prototype;
      text += "sensor " + sensor.name + " beams " + std::to_string(sensor.num_beams);
      append(text, "first_angle", scan.first_angle_rad / kDegree);
      append(text, "angle_step", scan.angle_step_rad / kDegree);
      if (scan.max_range_m > 0.0) append(text, "max_range", scan.max_range_m);
      if (scan.min_range_m > 0.0) append(text, "min_range", scan.min_range_m);
      append_mount(text, scan.robot_from_sensor);
      text += '\n';
    }
    return text;
  }

 private:
  static void append_mount(std::string& text, const MountPose& mount) {
    if (mount == MountPose{}) return;
    text += " mount";
    for (const double length_m : {mount.x_m, mount.y_m, mount.z_m}) append(text, length_m);
    for (const double angle_rad : {mount.yaw_rad, mount.pitch_rad, mount.roll_rad}) append(text, angle_rad / kDegree);
  }

  const Sensor* find(const SubScan& scan) const {
    for (const Sensor& sensor : sensors_) {
      if (sensor.made(scan)) return &sensor;
    }
    return nullptr;
  }

  void declare(const SubScan& scan) {
    Sensor sensor;
    sensor.name = free_name(scan.sensor_label);
    sensor.num_beams = scan.ranges_m.size();
    sensor.prototype = scan;
    sensor.prototype.ranges_m.clear();
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
  std::set<std::string> names_;
};

void append_scan(std::string& text, const SubScan& scan, const std::string& sensor) {
  text += "scan " + sensor;
  append(text, "heading", scan.nominal_heading_rad / kDegree);
  text += " ranges";
  for (const float range_m : scan.ranges_m) {
    text += ' ';
    if (std::isfinite(range_m) && range_m >= 0.0F) {
      append_number(text, range_m);
    } else {
      text += '-';
    }
  }
  text += '\n';
}

}  // namespace

void write_nist(const Log& log, ByteSink& sink) {
  const Sensors sensors(log);
  sink.write("shapemap-scans 1\nunits m deg\n" + sensors.text());
  for (const Position& position : log.positions) {
    std::string text = "position";
    append(text, position.timestamp_s);
    if (position.reference_pose) {
      append(text, "reference", position.reference_pose->x_m);
      append(text, position.reference_pose->y_m);
      append(text, position.reference_pose->theta_rad / kDegree);
    }
    text += '\n';
    for (const SubScan& scan : position.sub_scans) append_scan(text, scan, sensors.name_of(scan));
    sink.write(text);
  }
}

}  // namespace shapemap
