// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "shapemap/deskew/deskew.hpp"
#include "shapemap/grid/occupancy_grid.hpp"
#include "shapemap/grid/wall_direction.hpp"
#include "shapemap/io/log_file.hpp"
#include "shapemap/io/log_selection.hpp"
#include "shapemap/mapper/map_log.hpp"

/// The account of a run, for people and scripts.
namespace shapemap {

/// What a run had cost when so many positions of the log had been read; of several that are mapped as one, of all.
struct Milestone {
  std::size_t num_scans = 0;
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double peak_memory_mib = 0.0;
};

/// What a run cost; the caller measures it.
struct RunCosts {
  double read_s = 0.0;
  double map_s = 0.0;
  double write_s = 0.0;  ///< up to the report itself
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double peak_memory_mib = 0.0;
  std::vector<Milestone> milestones;
};

/// One of the logs that a map was made of.
struct LogFile {
  std::string path;
  std::string format;
};

/// How much of a fragment its picture shows.
struct DrawnComponent {
  int component = 0;  ///< index into MapResult::fragments
  std::size_t num_returns = 0;
  std::size_t num_outside = 0;  ///< of these, those that lie outside of the picture
};

struct RunReport {
  std::vector<LogFile> logs;
  const Log& log;  ///< the selected positions of all logs, see joined_logs()
  const MapResult& result;
  const MappingOptions& mapping;
  const LogReadOptions& reading;
  const SelectionOptions& selection;
  const OccupancyGridOptions& grid;
  std::vector<std::string> warnings;
  RunCosts costs;
  WallOptions walls{};
  std::vector<WallDirection> wall_directions{};  ///< of each fragment; empty when they were not asked for
  std::vector<DrawnComponent> drawn{};
  std::vector<SweepVerdict> sweeps{};  ///< one for each log, if any was asked about
};

/// One JSON object; see docs/cli.md for its members. What is not a number (a pose that does not exist) is null.
std::string json_report(const RunReport& report);

/// Names and versions of the library and of what it is built on.
std::vector<std::pair<std::string, std::string>> component_versions();

}  // namespace shapemap
