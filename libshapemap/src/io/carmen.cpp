// SPDX-License-Identifier: GPL-3.0-or-later
// This reader of CARMEN logs skips pose and odometry fields, which may hold anything, but for the heading.
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carmen.hpp"
#include "log_formats.hpp"
#include "mount_pose.hpp"
#include "shapemap/scan/beam_angles.hpp"
#include "shapemap/scan/plausibility.hpp"
#include "shapemap/scan/returns.hpp"
#include "text.hpp"

namespace shapemap {
namespace {

/// Counts the words between readings and timestamp; `odometry_at` is the first of the three of the odometry pose.
struct PoseWords {
  std::size_t count = 0;
  std::size_t odometry_at = 0;
};
constexpr PoseWords kFlaserPoses{6, 3};       // x y theta odom_x odom_y odom_theta
constexpr PoseWords kRobotLaserPoses{11, 3};  // laser pose, robot pose, tv rv forward_safety side_safety turn_axis

/// Reserves memory only for readings that the line has, so that a wrong count cannot ask for it.
std::vector<float> read_ranges(Words& words, const LineReader& lines) {
  const std::string_view word = words.next();
  const std::optional<long long> count = parse_count(word);
  if (!count || *count < 0) {
    throw lines.error("'" + std::string(word) + "' where the number of readings should be");
  }
  const std::size_t num_left = words.count_left();
  if (static_cast<unsigned long long>(*count) > num_left) {
    throw lines.error("too few values: the line announces " + std::to_string(*count) + " readings but has only " +
                      std::to_string(num_left) + " more values");
  }
  std::vector<float> ranges_m;
  ranges_m.reserve(static_cast<std::size_t>(*count));
  for (long long i = 0; i < *count; ++i) {
    const std::string_view reading = words.next();
    const std::optional<float> range_m = parse_range(reading, 1.0);
    if (!range_m) throw lines.error("reading " + std::to_string(i + 1) + " is '" + std::string(reading) + "'");
    ranges_m.push_back(*range_m);
  }
  return ranges_m;
}

double read_finite(Words& words, const LineReader& lines, const char* what) {
  const std::string_view word = words.next();
  const std::optional<double> value = parse_number(word);
  if (word.empty()) throw lines.error(std::string("too few values: ") + what + " is missing");
  if (!value || !std::isfinite(*value)) throw lines.error(std::string(what) + " is '" + std::string(word) + "'");
  return *value;
}

/// These fields follow the readings of a line.
struct PosesAndTime {
  std::optional<double> heading_rad;
  double timestamp_s = 0.0;
};

class CarmenReader {
 public:
  CarmenReader(ByteSource& source, const LogReadOptions& options)
      : source_(source), lines_(source), options_(options), choice_(options.sensor_label) {
    log_.format = "carmen";
  }

  Log read() {
    while (const std::optional<std::string_view> line = lines_.next()) read_line(*line);
    choice_.report(source_.path(), log_);
    finish_log(source_, log_);
    for (Scan& scan : log_.scans) {
      for (Sweep& sweep : scan.sweeps) {
        // the PARAM line may come after the first scans
        if (sweep.sensor_label == "FLASER") sweep.max_range_m = param_max_range_m_;
      }
    }
    return std::move(log_);
  }

 private:
  void read_line(std::string_view line) {
    Words words(line);
    const std::string_view keyword = words.next();
    if (keyword == "PARAM") read_param(words);
    if (keyword == "FLASER" && choice_.takes("FLASER", true)) read_flaser(words);
    if (keyword == "ROBOTLASER1" && choice_.takes("ROBOTLASER1", true)) read_robot_laser(words);
    if (keyword == "#") read_remark(words);
  }

  void read_param(Words words) {
    const std::string_view name = words.next();
    if (name != "robot_front_laser_max" && name != "robot_frontlaser_max") return;
    const std::optional<double> value = parse_number(words.next());
    if (value && *value > 0.0 && *value < kLongestRange_m) param_max_range_m_ = *value;
  }

  /// Reads the remarks of write_carmen() on what CARMEN has no field for.
  void read_remark(Words words) {
    if (words.next() != "shapemap") return;
    const std::string_view what = words.next();
    if (what == "same-position") joins_previous_ = true;
    if (what == "mount") mount_ = read_mount(words);
  }

  MountPose read_mount(Words& words) {
    MountPose mount;
    for (double* field : {&mount.x_m, &mount.y_m, &mount.z_m, &mount.yaw_rad, &mount.pitch_rad, &mount.roll_rad}) {
      *field = read_finite(words, lines_, "a field of the laser's mount");
    }
    return mount;
  }

  void read_flaser(Words& words) {
    Sweep sweep;
    sweep.ranges_m = read_ranges(words, lines_);
    set_flaser_angles(sweep);
    sweep.sensor_label = "FLASER";
    add(std::move(sweep), read_poses(words, kFlaserPoses));
  }

  void set_flaser_angles(Sweep& sweep) {
    const std::size_t num_beams = sweep.ranges_m.size();
    if (num_beams == 0) return;
    if (options_.fov_rad > 0.0) {
      if (num_beams < 2) throw lines_.error("one reading has no field of view, expected two or more");
      sweep.first_angle_rad = -options_.fov_rad / 2;
      sweep.angle_step_rad = options_.fov_rad / static_cast<double>(num_beams - 1);
      return;
    }
    const std::optional<double> step_rad = flaser_step_rad(num_beams);
    if (!step_rad) {
      throw lines_.error("a FLASER with " + std::to_string(num_beams) +
                         " readings has no convention for its angles (180, 181, 360 and 361 have); give --fov-deg");
    }
    sweep.first_angle_rad = kFlaserFirstAngle_rad;
    sweep.angle_step_rad = *step_rad;
  }

  void read_robot_laser(Words& words) {
    Sweep sweep;
    words.skip(1);  // laser type
    const double start_rad = read_finite(words, lines_, "the start angle");
    const double fov_rad = read_finite(words, lines_, "the field of view");
    const double resolution_rad = read_finite(words, lines_, "the angular resolution");
    sweep.max_range_m = std::max(0.0, read_finite(words, lines_, "the maximum range"));
    words.skip(2);  // accuracy, remission mode
    sweep.ranges_m = read_ranges(words, lines_);
    sweep.sensor_label = "ROBOTLASER1";

    set_robot_laser_angles(start_rad, fov_rad, resolution_rad, sweep);
    skip_remissions(words);
    add(std::move(sweep), read_poses(words, kRobotLaserPoses));
  }

  void set_robot_laser_angles(double start_rad, double fov_rad, double resolution_rad, Sweep& sweep) {
    StatedAngles stated;
    stated.first_rad = start_rad;
    if (resolution_rad != 0.0) stated.step_rad = resolution_rad;
    if (fov_rad != 0.0) stated.last_rad = start_rad + (resolution_rad < 0.0 ? -std::abs(fov_rad) : fov_rad);
    const std::optional<EvenBeams> beams = even_beams(stated, sweep.ranges_m.size());
    if (!beams) {
      throw lines_.error(
          "neither the angular resolution nor the field of view says where the beams point, expected "
          "one that is not 0 and makes at most a full turn");
    }
    sweep.first_angle_rad = beams->first_rad;
    sweep.angle_step_rad = beams->step_rad;
    if (beams->source != AngleSource::kAsStated) warn_of_angles(beams->source);
  }

  void warn_of_angles(AngleSource used) {
    if (!warned_of_angles_) {
      log_.warnings.push_back(lines_.where() + ": field of view and angular resolution contradict each other; the " +
                              (used == AngleSource::kStep ? "resolution" : "field of view") + " is used");
    }
    warned_of_angles_ = true;
  }

  void skip_remissions(Words& words) {
    const std::string_view word = words.next();
    const std::optional<long long> count = parse_count(word);
    if (word.empty()) throw lines_.error("too few values: the number of remissions is missing");
    if (!count || *count < 0) {
      throw lines_.error("'" + std::string(word) + "' where the number of remissions should be");
    }
    const auto wanted = static_cast<std::size_t>(*count);
    if (words.skip(wanted) < wanted) {
      throw lines_.error("too few values: the line announces " + std::to_string(wanted) + " remissions");
    }
  }

  /// Reads the pose words, which may hold anything. Logs without odometry have zeros there.
  PosesAndTime read_poses(Words& words, const PoseWords& poses) {
    PosesAndTime read;
    std::array<std::optional<double>, 3> odometry;
    std::size_t num_words = words.skip(poses.odometry_at);
    for (std::optional<double>& value : odometry) {
      const std::string_view word = words.next();
      if (!word.empty()) ++num_words;
      value = parse_number(word);
    }
    num_words += words.skip(poses.count - poses.odometry_at - odometry.size());
    if (num_words < poses.count) {
      throw lines_.error("too few values: expected " + std::to_string(poses.count) +
                         " pose fields and a timestamp after the readings");
    }
    const bool is_all_zero = odometry[0] == 0.0 && odometry[1] == 0.0 && odometry[2] == 0.0;
    if (odometry[2] && std::isfinite(*odometry[2]) && !is_all_zero) read.heading_rad = wrap_angle(*odometry[2]);
    read.timestamp_s = read_finite(words, lines_, "the timestamp");
    return read;
  }

  void add(Sweep sweep, const PosesAndTime& poses) {
    sweep.robot_from_sensor = mount_;
    mount_ = MountPose{};
    lines_.require_plausible(sweep);
    lines_.refuse(implausible_time(poses.timestamp_s));
    if (!joins_previous_ || log_.scans.empty()) {
      log_.scans.emplace_back();
      log_.scans.back().timestamp_s = poses.timestamp_s;
      log_.scans.back().recorded_heading_rad = poses.heading_rad;
    }
    joins_previous_ = false;
    log_.scans.back().sweeps.push_back(std::move(sweep));
  }

  ByteSource& source_;
  LineReader lines_;
  const LogReadOptions& options_;
  LaserChoice choice_;
  Log log_;
  double param_max_range_m_ = 0.0;
  bool warned_of_angles_ = false;
  MountPose mount_;              ///< the mount of the next sweep
  bool joins_previous_ = false;  ///< the next sweep is of the same scan
};

}  // namespace

std::optional<double> flaser_step_rad(std::size_t num_beams) {
  if (num_beams == 180 || num_beams == 181) return 1.0 * kDegree;
  if (num_beams == 360 || num_beams == 361) return 0.5 * kDegree;
  return std::nullopt;
}

Log read_carmen(ByteSource& source, const LogReadOptions& options) { return CarmenReader(source, options).read(); }

}  // namespace shapemap
