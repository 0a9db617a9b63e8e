// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "option_table.hpp"
#include "settings.hpp"

/// The arguments are checked as far as that can be done without reading the log.
namespace shapemap::cli {

enum class Verbosity { kQuiet, kNormal, kVerbose };

struct LogSource {
  std::string path;
  LogFormat format = LogFormat::kAuto;
};

struct MapArguments {
  std::vector<LogSource> logs;  ///< no file occurs twice
  std::string map_path;
  std::string trajectory_path;
  std::string motions_path;
  std::string carmen_path;
  std::string rawlog_path;
  std::string report_path;
  std::string trace_path;
  std::string fragments_folder;
  std::string state_path;
  std::string config_path;  ///< has been applied to `settings`
  bool resume = false;      ///< continues from `state_path`
  bool force = false;
  bool dump_config = false;  ///< print the options and do nothing else
  Verbosity verbosity = Verbosity::kNormal;
  MapSettings settings;
};

struct InfoArguments {
  std::string log_path;
  LogFormat format = LogFormat::kAuto;
  LogReadOptions reading;
};

struct ConvertArguments {
  std::string in_path;
  std::string out_path;
  LogFormat from = LogFormat::kAuto;
  LogFormat to = LogFormat::kAuto;  ///< as given or by the ending of `out_path`; never kAuto
  bool force = false;
  LogReadOptions reading;
};

struct AlignArguments {
  std::string log_path;
  std::string other_path;  ///< log of the queries; empty: `log_path`
  LogFormat format = LogFormat::kAuto;
  int gap = 0;  ///< 0: `pairs_path` lists the pairs
  std::string pairs_path;
  std::string out_path;
  std::string config_path;  ///< has been applied to `settings`
  bool force = false;
  bool timings = false;
  bool dump_config = false;  ///< prints the options and does nothing else
  bool quiet = false;
  MapSettings settings;
};

/// These functions parse the arguments after the program's name, or after the command's. They return nothing when help
/// or the version was asked for and printed, and throw ConfigError for wrong usage.
std::optional<MapArguments> parse_map_arguments(const std::vector<std::string>& typed);
std::optional<InfoArguments> parse_info_arguments(const std::vector<std::string>& typed);
std::optional<ConvertArguments> parse_convert_arguments(const std::vector<std::string>& typed);
std::optional<AlignArguments> parse_align_arguments(const std::vector<std::string>& typed);

/// Parses the arguments of `numbers`, which takes none. Returns false when help or the version was asked for and
/// printed. Throws ConfigError for wrong usage.
bool parse_numbers_arguments(const std::vector<std::string>& typed);

/// Returns the options of `settings` that matching pairs depends on. The table must not outlive `settings`.
OptionTable align_option_table(MapSettings& settings);

}  // namespace shapemap::cli
