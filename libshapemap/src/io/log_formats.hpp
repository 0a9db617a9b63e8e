// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "byte_sink.hpp"
#include "byte_source.hpp"
#include "shapemap/io/log_file.hpp"

/// Each format has a reader and a writer; this header also has what they share.
namespace shapemap {

Log read_rawlog(ByteSource& source, const LogReadOptions& options);
Log read_carmen(ByteSource& source, const LogReadOptions& options);
Log read_nist(ByteSource& source, const LogReadOptions& options);

void write_rawlog(const Log& log, const LogPoses* poses, ByteSink& sink);
void write_carmen(const Log& log, const LogPoses* poses, ByteSink& sink);
void write_nist(const Log& log, ByteSink& sink);

/// Recognises the format of `source` without consuming it. Throws InputError when nothing fits.
LogFormat recognise_log_format(ByteSource& source);
bool looks_like_rawlog(std::string_view content);

/// Chooses the lasers of a log that are used, and warns of the others.
class LaserChoice {
 public:
  explicit LaserChoice(std::string wanted_label) : wanted_(std::move(wanted_label)) {}
  /// Counts a sweep of `label` and says whether it is used. With `only_first` and no wish of the user, the laser that
  /// comes first is chosen.
  bool takes(const std::string& label, bool only_first);
  /// Throws InputError when the wanted laser is missing; warns of lasers that were left out.
  void report(const std::string& path, Log& log) const;

 private:
  std::string wanted_;
  std::string first_;
  bool has_first_ = false;
  std::map<std::string, std::size_t> left_out_;
};

/// Throws InputError when `log` has no scans, and warns of a cut gzip stream.
void finish_log(const ByteSource& source, Log& log);

}  // namespace shapemap
