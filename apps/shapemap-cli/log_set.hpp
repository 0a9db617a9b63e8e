// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arguments.hpp"
#include "shapemap/io/report.hpp"
#include "shapemap/scan/joined_logs.hpp"

/// A run may have several logs; this header names their scans and outputs.
namespace shapemap::cli {

struct LogSet {
  std::vector<LogFile> files;
  Log log;  ///< the selected scans of all logs
  SelectionOptions selection;

  bool is_one() const { return files.size() == 1; }
  /// Returns a name such as "position 7", with the log if there are several; it counts in the whole log.
  std::string scan_name(std::size_t index) const;
};

/// Reads the logs and selects scans of each. Throws InputError and ConfigError, which name the log.
LogSet read_logs(const MapArguments& arguments);

/// Returns a short name for each log: its file name without endings, numbered where two are the same.
std::vector<std::string> short_names(const std::vector<LogSource>& logs);

/// Returns the path of each log's part of the output `path`: `path` itself for a single log, else out.tum becomes
/// out.NAME.tum.
std::vector<std::string> per_log_paths(const std::string& path, const std::vector<LogSource>& logs);

/// Returns the scans of `placed` that are from one of the logs.
std::vector<PlacedScan> placed_of(const std::vector<PlacedScan>& placed, const LogPart& part);

}  // namespace shapemap::cli
