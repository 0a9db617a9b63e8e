// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/log_file.hpp"

#include "log_formats.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/core/printable.hpp"
#include "shapemap/scan/no_return.hpp"
#include "shapemap/scan/timestamps.hpp"

namespace shapemap {
namespace {

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

std::string quoted(const std::string& label) { return "'" + printable(label, kMostNameShown) + "'"; }

}  // namespace

bool LaserChoice::takes(const std::string& label, bool only_first) {
  if (!has_first_) first_ = label;
  has_first_ = true;
  const bool taken = wanted_.empty() ? (!only_first || label == first_) : label == wanted_;
  if (!taken) ++left_out_[label];
  return taken;
}

void LaserChoice::report(const std::string& path, Log& log) const {
  std::string others;
  for (const auto& [label, count] : left_out_) {
    others += (others.empty() ? "" : ", ") + quoted(label) + " (" + std::to_string(count) + " scans)";
  }
  if (log.scans.empty() && !wanted_.empty() && !others.empty()) {
    throw InputError(path + ": no scans of a laser called " + quoted(wanted_) + "; the log has " + others);
  }
  if (wanted_.empty() && !others.empty()) {
    log.warnings.push_back(path + ": only laser " + quoted(first_) +
                           " is used; --sensor-label picks another: " + others);
  }
}

void finish_log(const ByteSource& source, Log& log) {
  if (log.scans.empty()) {
    if (!source.cut().empty()) throw InputError(source.path() + ": " + source.cut() + ", no whole scan before that");
    throw InputError(source.path() + ": no 2D laser scans in it");
  }
  if (!source.cut().empty()) {
    log.warnings.push_back(source.path() + ": " + source.cut() + "; the " + std::to_string(log.scans.size()) +
                           " positions before that are used");
  }
}

namespace {

Log read_as(ByteSource& source, LogFormat format, const LogReadOptions& options) {
  switch (format == LogFormat::kAuto ? recognise_log_format(source) : format) {
    case LogFormat::kRawlog:
      return read_rawlog(source, options);
    case LogFormat::kCarmen:
      return read_carmen(source, options);
    case LogFormat::kNist:
      return read_nist(source, options);
    case LogFormat::kAuto:
      break;
  }
  throw InputError(source.path() + ": unknown log format");
}

/// Converts readings to metres if the log does not state their unit.
void convert_range_unit(const std::string& path, RangeUnit unit, Log& log) {
  if (log.states_range_unit) return;
  const bool is_recognised = unit == RangeUnit::kAuto;
  if (is_recognised) unit = recognised_range_unit(log);
  scale_ranges(log, unit);
  if (!is_recognised || unit == RangeUnit::kMetre) return;
  log.warnings.push_back(path + ": the readings are taken for " +
                         (unit == RangeUnit::kMillimetre ? "millimetres" : "centimetres") +
                         ", since they are too long for metres; --range-unit says otherwise");
}

void turn_upside_down(Log& log) {
  for (Scan& scan : log.scans) {
    for (Sweep& sweep : scan.sweeps) {
      sweep.robot_from_sensor.roll_rad = wrap_angle(sweep.robot_from_sensor.roll_rad + kPi);
    }
  }
}

}  // namespace

Log read_log(const std::string& path, LogFormat format, const LogReadOptions& options) {
  validate(options);
  const NoReturnChoice no_returns = no_return_choice(options.no_return_m);
  ByteSource source(path);
  Log log = read_as(source, format, options);
  convert_range_unit(path, options.range_unit, log);
  const std::size_t num_of_reader = log.warnings.size();
  sort_out_no_returns(log, no_returns);
  for (std::size_t i = num_of_reader; i < log.warnings.size(); ++i) log.warnings[i] = path + ": " + log.warnings[i];
  for (const std::string& line : mend_timestamps(log.scans).lines()) log.warnings.push_back(path + ": " + line);
  if (options.upside_down) turn_upside_down(log);
  return log;
}

std::string what_is_lost(const Log& log, LogFormat format) {
  if (format == LogFormat::kNist) return "";
  bool headings = false;
  bool references = false;
  bool uneven = false;
  bool timed = false;
  bool intense = false;
  for (const Scan& scan : log.scans) {
    references = references || scan.reference_pose.has_value();
    for (const Sweep& sweep : scan.sweeps) {
      headings = headings || sweep.nominal_heading_rad != 0.0;
      uneven = uneven || !sweep.is_evenly_spaced();
      timed = timed || sweep.start_s != 0.0 || sweep.beam_time_step_s > 0.0 || !sweep.beam_times_s.empty();
      intense = intense || !sweep.intensities.empty();
    }
  }
  std::string lost;
  const auto lose = [&](bool is_lost, const char* what) {
    if (is_lost) lost += std::string(lost.empty() ? "" : ", ") + what;
  };
  lose(headings, "nominal headings become part of the mounts of the lasers");
  lose(references, "reference poses are left out");
  lose(uneven, "readings go to the nearest of evenly spaced beams");
  lose(timed, "times of beams are left out");
  lose(intense, "intensities are left out");
  return lost.empty() ? "" : "a " + enum_name(format) + " log cannot hold all: " + lost;
}

void write_log(const Log& log, const std::string& path, LogFormat format, const LogPoses* poses) {
  if (format == LogFormat::kAuto) throw OutputError(path + ": a format to write must be named: rawlog, carmen or nist");
  if (poses != nullptr && poses->map_from_robot.size() != log.scans.size()) {
    throw OutputError(path + ": " + std::to_string(poses->map_from_robot.size()) + " poses for " +
                      std::to_string(log.scans.size()) + " positions");
  }
  // MRPT's own tools always compress their .rawlog files; they read nothing else without asking.
  const bool compress = format == LogFormat::kRawlog || ends_with(path, ".gz");
  ByteSink sink(path, compress ? ByteSink::Compression::kGzip : ByteSink::Compression::kNone);
  if (format == LogFormat::kRawlog) write_rawlog(log, poses, sink);
  if (format == LogFormat::kCarmen) write_carmen(log, poses, sink);
  if (format == LogFormat::kNist) write_nist(log, sink);
  sink.commit();
}

}  // namespace shapemap
