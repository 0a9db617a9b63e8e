// SPDX-License-Identifier: GPL-3.0-or-later
#include "rawlog.hpp"

#include <sstream>
#include <stdexcept>
#include <utility>

#include "log_formats.hpp"
#include "rawlog_skeleton.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/core/printable.hpp"
#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

class RawlogReader {
 public:
  RawlogReader(ByteSource& source, const LogReadOptions& options)
      : source_(source), skeleton_(source), choice_(options.sensor_label) {
    log_.format = "rawlog";
    log_.states_range_unit = true;  // MRPT has only metres
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
    if (log_.scans.empty() && num_unusable_ == 0 && !damage.empty()) {
      throw InputError(source_.path() + ": " + damage + ", no whole scan before that");
    }
    choice_.report(source_.path(), log_);
    if (log_.scans.empty() && num_unusable_ > 0) throw InputError(source_.path() + ": " + unusable_text());
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
      Scan scan;
      // Observations stand alone here: with several lasers, each would make its own scans.
      read_scan(scan, true);
      add(std::move(scan));
    } else {
      skeleton_.skip_object();
    }
  }

  void read_frame() {
    const std::uint32_t num_observations = skeleton_.enter_frame();
    Scan scan;
    bool frame_open = true;
    for (std::uint32_t i = 0; i < num_observations; ++i) {
      const ObjectHeader header = skeleton_.peek_header();
      frame_open = header.name == kScanClass;
      if (frame_open) {
        read_scan(scan, false);
      } else if (header.name.substr(0, 12) == "CObservation") {
        skeleton_.skip_object();
      } else {
        throw RawlogDamage{skeleton_.offset(), "a frame with fewer observations than it announces"};
      }
    }
    if (frame_open) skeleton_.leave_frame();
    add(std::move(scan));
  }

  void read_scan(Scan& scan, bool only_first) {
    const std::string_view object = skeleton_.peek_scan();
    RawlogScan read;
    try {
      read = scan_from_rawlog(object);
    } catch (const std::runtime_error& error) {
      const std::string reason = error.what();
      throw RawlogDamage{skeleton_.offset(), "unreadable scan: " + reason.substr(0, reason.find('\n'))};
    }
    const std::uint64_t offset = skeleton_.offset();
    skeleton_.skip(object.size());
    if (!choice_.takes(read.sweep.sensor_label, only_first)) return;
    const std::string fault = fault_of(read);
    if (!fault.empty()) {
      if (num_unusable_++ == 0) first_unusable_ = fault + " (the first at offset " + std::to_string(offset) + ")";
      return;
    }
    if (scan.sweeps.empty()) scan.timestamp_s = timestamp_of(read);
    scan.sweeps.push_back(std::move(read.sweep));
  }

  static std::string fault_of(const RawlogScan& read) {
    if (read.sweep.ranges_m.empty()) return "no beams";
    const std::string fault = implausibility(read.sweep);
    return fault.empty() && read.timestamp_s ? implausible_time(*read.timestamp_s) : fault;
  }

  double timestamp_of(const RawlogScan& read) {
    if (read.timestamp_s) return *read.timestamp_s;
    ++num_without_time_;
    return static_cast<double>(log_.scans.size());
  }

  void add(Scan scan) {
    if (scan.sweeps.empty()) return;
    const std::string fault = implausible_count(log_.scans.size(), "positions");
    if (!fault.empty()) throw RawlogDamage{skeleton_.offset(), fault};
    log_.scans.push_back(std::move(scan));
  }

  std::string unusable_text() const {
    return std::to_string(num_unusable_) + (num_unusable_ == 1 ? " scan is left out: " : " scans are left out: ") +
           printable(first_unusable_);
  }

  void warn_of_oddities() {
    if (num_unusable_ > 0) log_.warnings.push_back(source_.path() + ": " + unusable_text());
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
  std::string first_unusable_;  ///< the fault of the first of them, and its offset
  std::size_t num_without_time_ = 0;
};

/// MRPT counts time in 64 bits of 100 ns since the year 1601.
void require_rawlog_time(const Scan& scan, std::size_t index) {
  constexpr double kEarliest_s = -11644473600.0;
  constexpr double kLatest_s = 9.1e11;
  if (scan.timestamp_s > kEarliest_s && scan.timestamp_s < kLatest_s) return;  // written so that NaN fails
  std::ostringstream why;
  why << "position " << index << " has the timestamp " << scan.timestamp_s << ", which a rawlog cannot hold";
  throw OutputError(why.str());
}

}  // namespace

Log read_rawlog(ByteSource& source, const LogReadOptions& options) { return RawlogReader(source, options).read(); }

/// Writes an action, with odometry if there are poses, and a frame per scan, since MRPT's readers take only such pairs.
void write_rawlog(const Log& log, const LogPoses* poses, ByteSink& sink) {
  for (std::size_t i = 0; i < log.scans.size(); ++i) require_rawlog_time(log.scans[i], i);
  Pose2 map_from_previous;
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    const Scan& scan = log.scans[i];
    std::optional<Pose2> previous_from_current;
    if (poses != nullptr) {
      previous_from_current = inverse(map_from_previous) * poses->map_from_robot[i];
      map_from_previous = poses->map_from_robot[i];
    }
    sink.write(action_to_rawlog(previous_from_current, scan.timestamp_s));
    sink.write(frame_to_rawlog(scan));
  }
}

}  // namespace shapemap
