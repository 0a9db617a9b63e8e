// SPDX-License-Identifier: GPL-3.0-or-later
// The writer uses FLASER lines where their convention covers the whole log, else ROBOTLASER1 lines. CARMEN lines hold
// one sweep and no mount; both are kept in remarks that other programs skip and read_carmen() understands:
//   # shapemap same-position                      the next sweep belongs to the scan of the previous one
//   # shapemap mount X Y Z YAW PITCH ROLL         of the next sweep's laser, metres and radians, turn included
// The laser pose fields of ROBOTLASER1 tell other programs the planar part of the mount.
#include <cmath>

#include "carmen.hpp"
#include "log_formats.hpp"
#include "mount_pose.hpp"
#include "shapemap/scan/beam_angles.hpp"
#include "shapemap/scan/returns.hpp"
#include "text.hpp"

namespace shapemap {
namespace {

constexpr const char* kHeader = "# CARMEN log written by shapemap; poses are estimates, zero where there are none\n";

bool fits_flaser(const Sweep& sweep) {
  if (!sweep.is_evenly_spaced()) return false;
  const std::optional<double> step_rad = flaser_step_rad(sweep.ranges_m.size());
  return step_rad && std::abs(sweep.angle_step_rad - *step_rad) < 1e-9 &&
         std::abs(sweep.first_angle_rad - kFlaserFirstAngle_rad) < 1e-9 && mount_with_heading(sweep) == MountPose{};
}

/// Returns the maximum range of all scans, or 0, when FLASER lines can hold the log, and nothing when they cannot. The
/// whole log has one kind of line, since readers take two kinds for two lasers.
std::optional<double> flaser_max_range_m(const Log& log) {
  std::optional<double> max_range_m;
  for (const Scan& scan : log.scans) {
    if (scan.sweeps.size() != 1 || !fits_flaser(scan.sweeps.front())) return std::nullopt;
    const double scan_max_m = scan.sweeps.front().max_range_m;
    if (max_range_m && *max_range_m != scan_max_m) return std::nullopt;
    max_range_m = scan_max_m;
  }
  return max_range_m;
}

class CarmenText {
 public:
  CarmenText& operator<<(std::string_view word) {
    text_ += word;
    return *this;
  }
  CarmenText& operator<<(double value) {
    text_ += ' ';
    append_number(text_, value);
    return *this;
  }
  CarmenText& operator<<(std::size_t value) {
    text_ += ' ';
    append_number(text_, value);
    return *this;
  }
  CarmenText& operator<<(const Pose2& pose) { return *this << pose.x_m << pose.y_m << pose.theta_rad; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Writes every reading that is a return by the limits of the sweep, and the maximum or 0 for the others, since CARMEN
/// knows no minimum range and no flags.
void write_ranges(const Sweep& sweep, CarmenText& line) {
  const RangeLimits limits = range_limits(sweep, ReturnOptions{});
  line << sweep.ranges_m.size();
  std::string text;
  for (const float range_m : sweep.ranges_m) {
    text += ' ';
    if (is_return(range_m, limits)) {
      append_number(text, range_m);
    } else {
      append_number(text, sweep.max_range_m > 0.0 ? static_cast<float>(sweep.max_range_m) : 0.0F);
    }
  }
  line << text;
}

void write_time(double timestamp_s, CarmenText& line) { line << timestamp_s << " shapemap" << timestamp_s << "\n"; }

void write_flaser(const Sweep& sweep, const Pose2& map_from_robot, double timestamp_s, CarmenText& line) {
  line << "FLASER";
  write_ranges(sweep, line);
  line << map_from_robot << map_from_robot;
  write_time(timestamp_s, line);
}

void write_robot_laser(const Sweep& clockwise_or_not, const Pose2& map_from_robot, double timestamp_s,
                       CarmenText& line) {
  const Sweep sweep = counterclockwise(on_even_beams(clockwise_or_not));
  const MountPose mount = mount_with_heading(sweep);
  if (!(mount == MountPose{})) {
    line << "# shapemap mount" << mount.x_m << mount.y_m << mount.z_m << mount.yaw_rad << mount.pitch_rad
         << mount.roll_rad << "\n";
  }
  const double num_steps = static_cast<double>(sweep.ranges_m.size()) - 1.0;
  line << "ROBOTLASER1 0" << sweep.first_angle_rad << sweep.angle_step_rad * num_steps << sweep.angle_step_rad
       << sweep.max_range_m << " 0 0";
  write_ranges(sweep, line);
  line << " 0" << map_from_robot * robot_from_sensor2(sweep) << map_from_robot << " 0 0 0 0 0";
  write_time(timestamp_s, line);
}

}  // namespace

void write_carmen(const Log& log, const LogPoses* poses, ByteSink& sink) {
  sink.write(kHeader);
  const std::optional<double> flaser_max_m = flaser_max_range_m(log);
  if (flaser_max_m && *flaser_max_m > 0.0) {
    CarmenText line;
    line << "PARAM robot_front_laser_max" << *flaser_max_m << " shapemap 0\n";
    sink.write(line.text());
  }
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    const Scan& scan = log.scans[i];
    const Pose2 map_from_robot = poses != nullptr ? poses->map_from_robot[i] : Pose2{};
    bool is_first = true;
    for (const Sweep& sweep : scan.sweeps) {
      CarmenText line;
      if (!is_first) line << "# shapemap same-position\n";
      is_first = false;
      if (flaser_max_m) {
        write_flaser(sweep, map_from_robot, scan.timestamp_s, line);
      } else {
        write_robot_laser(sweep, map_from_robot, scan.timestamp_s, line);
      }
      sink.write(line.text());
    }
  }
}

}  // namespace shapemap
