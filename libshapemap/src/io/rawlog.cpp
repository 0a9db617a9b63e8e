// SPDX-License-Identifier: GPL-3.0-or-later
#include "rawlog.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "log_formats.hpp"
#include "rawlog_skeleton.hpp"
#include "shapemap/core/errors.hpp"

namespace shapemap {
namespace {

class RawlogReader {
 public:
  RawlogReader(ByteSource& source, const LogReadOptions& options)
      : source_(source), skeleton_(source), choice_(options.sensor_label) {
    log_.format = "rawlog";
  }

  Log read() {
    source_.ensure(1U << 16U);
    if (!looks_like_rawlog(source_.buffered())) {
      throw InputError(source_.path() + ": no MRPT rawlog: expected an object of MRPT 0.5.5 or newer at its start");
    }
    std::string damage;
    try {
      for (; !skeleton_.at_end(); ++num_entries_) read_entry();
    } catch (const RawlogDamage& found) {
      damage = describe(found);
    }
    if (log_.positions.empty() && !damage.empty()) {
      throw InputError(source_.path() + ": " + damage + ", no whole scan before that");
    }
    choice_.report(source_.path(), log_);
    if (damage.empty()) finish_log(source_, log_);
    if (!damage.empty()) log_.warnings.push_back(source_.path() + ": " + damage + "; what is before that is used");
    warn_of_oddities();
    return std::move(log_);
  }

 private:
  std::string describe(const RawlogDamage& found) const {
    const std::string cut = source_.cut().empty() ? "" : " (" + source_.cut() + ")";
    return "damaged or cut off after " + std::to_string(num_entries_) + " whole entries, at offset " +
           std::to_string(found.offset) + " of its content: " + found.what + cut;
  }

  void read_entry() {
    const ObjectHeader header = skeleton_.peek_header();
    if (header.name == kFrameClass) {
      read_frame();
    } else if (header.name == kScanClass) {
      Position position;
      // Observations stand alone here: with several lasers, each would make its own positions.
      read_scan(position, true);
      add(std::move(position));
    } else {
      skeleton_.skip_object();
    }
  }

  void read_frame() {
    const std::uint32_t num_observations = skeleton_.enter_frame();
    Position position;
    bool frame_open = true;
    for (std::uint32_t i = 0; i < num_observations; ++i) {
      const ObjectHeader header = skeleton_.peek_header();
      frame_open = header.name == kScanClass;
      if (frame_open) {
        read_scan(position, false);
      } else if (header.name.substr(0, 12) == "CObservation") {
        skeleton_.skip_object();
      } else {
        throw RawlogDamage{skeleton_.offset(), "a frame with fewer observations than it announces"};
      }
    }
    if (frame_open) skeleton_.leave_frame();
    add(std::move(position));
  }

  void read_scan(Position& position, bool only_first) {
    const std::string_view object = skeleton_.peek_scan();
    RawlogScan read;
    try {
      read = scan_from_rawlog(object);
    } catch (const std::runtime_error& error) {
      const std::string reason = error.what();
      throw RawlogDamage{skeleton_.offset(), "unreadable scan: " + reason.substr(0, reason.find('\n'))};
    }
    skeleton_.skip(object.size());
    if (!choice_.takes(read.scan.sensor_label, only_first)) return;
    if (!is_usable(read.scan)) {
      ++num_unusable_;
      return;
    }
    if (position.sub_scans.empty()) position.timestamp_s = timestamp_of(read);
    position.sub_scans.push_back(std::move(read.scan));
  }

  static bool is_usable(const SubScan& scan) {
    const MountPose& mount = scan.robot_from_sensor;
    double sum = scan.first_angle_rad + scan.angle_step_rad;
    for (const double part : {mount.x_m, mount.y_m, mount.z_m, mount.yaw_rad, mount.pitch_rad, mount.roll_rad}) {
      sum += part;
    }
    return !scan.ranges_m.empty() && std::isfinite(sum);
  }

  double timestamp_of(const RawlogScan& read) {
    if (read.timestamp_s) return *read.timestamp_s;
    ++num_without_time_;
    return static_cast<double>(log_.positions.size());
  }

  void add(Position position) {
    if (!position.sub_scans.empty()) log_.positions.push_back(std::move(position));
  }

  void warn_of_oddities() {
    if (num_unusable_ > 0) {
      log_.warnings.push_back(source_.path() + ": " + std::to_string(num_unusable_) +
                              " scans without beams or with angles or mounts that are no numbers are left out");
    }
    if (num_without_time_ > 0) {
      log_.warnings.push_back(source_.path() + ": " + std::to_string(num_without_time_) +
                              " positions have no timestamp; their index in seconds is taken");
    }
  }

  ByteSource& source_;
  RawlogSkeleton skeleton_;
  LaserChoice choice_;
  Log log_;
  std::size_t num_entries_ = 0;
  std::size_t num_unusable_ = 0;
  std::size_t num_without_time_ = 0;
};

/// MRPT counts time in 64 bits of 100 ns since the year 1601.
void require_rawlog_time(const Position& position, std::size_t index) {
  constexpr double kEarliest_s = -11644473600.0;
  constexpr double kLatest_s = 9.1e11;
  if (position.timestamp_s > kEarliest_s && position.timestamp_s < kLatest_s) return;  // written so that NaN fails
  std::ostringstream why;
  why << "position " << index << " has the timestamp " << position.timestamp_s << ", which a rawlog cannot hold";
  throw OutputError(why.str());
}

}  // namespace

Log read_rawlog(ByteSource& source, const LogReadOptions& options) { return RawlogReader(source, options).read(); }

/// An action, with odometry if there are poses, and a frame per position: MRPT's readers take nothing but such pairs.
void write_rawlog(const Log& log, const LogPoses* poses, ByteSink& sink) {
  for (std::size_t i = 0; i < log.positions.size(); ++i) require_rawlog_time(log.positions[i], i);
  Pose2 map_from_previous;
  for (std::size_t i = 0; i < log.positions.size(); ++i) {
    const Position& position = log.positions[i];
    std::optional<Pose2> previous_from_current;
    if (poses != nullptr) {
      previous_from_current = inverse(map_from_previous) * poses->map_from_robot[i];
      map_from_previous = poses->map_from_robot[i];
    }
    sink.write(action_to_rawlog(previous_from_current, position.timestamp_s));
    sink.write(frame_to_rawlog(position));
  }
}

}  // namespace shapemap
