// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arguments.hpp"
#include "shapemap/io/report.hpp"
#include "shapemap/scan/joined_logs.hpp"

/// The logs of a run, and how their positions and outputs are called.
namespace shapemap::cli {

struct LogSet {
  std::vector<LogFile> files;
  Log log;  ///< the selected positions of all
  SelectionOptions selection;

  bool is_one() const { return files.size() == 1; }
  /// "position 7", and of which log if there are several; counted in that whole log.
  std::string scan_name(std::size_t index) const;
};

/// Reads them, and selects positions of each. Throws InputError and ConfigError, naming the log.
LogSet read_logs(const MapArguments& arguments);

/// What a user would call each log: its file name without endings, numbered where two are the same.
std::vector<std::string> short_names(const std::vector<LogSource>& logs);

/// Where each log gets what was asked for as `path`: there if it is the only one, else out.tum becomes out.NAME.tum.
std::vector<std::string> per_log_paths(const std::string& path, const std::vector<LogSource>& logs);

/// The positions of `placed` that are from one of the logs.
std::vector<PlacedScan> placed_of(const std::vector<PlacedScan>& placed, const LogPart& part);

}  // namespace shapemap::cli
