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

/// The report is the account of a run, for people and scripts.
namespace shapemap {

/// The costs of a run when so many scans of the log, or of all logs that are mapped together, had been read.
struct Milestone {
  std::size_t num_scans = 0;
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double peak_memory_mib = 0.0;
};

/// The caller measures these costs of a run.
struct RunCosts {
  double read_s = 0.0;
  double map_s = 0.0;
  double write_s = 0.0;  ///< without the report itself
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

/// Tells how much of a component its picture shows.
struct DrawnComponent {
  int component = 0;  ///< index into MapResult::components
  std::size_t num_returns = 0;
  std::size_t num_outside = 0;  ///< number of these that lie outside of the picture
};

struct RunReport {
  std::vector<LogFile> logs;
  const Log& log;  ///< the selected scans of all sessions, see joined_logs()
  const MapResult& result;
  const MappingOptions& mapping;
  const LogReadOptions& reading;
  const SelectionOptions& selection;
  const OccupancyGridOptions& grid;
  std::vector<std::string> warnings;
  RunCosts costs;
  WallOptions walls{};
  std::vector<WallDirection> wall_directions{};  ///< one for each component; empty when walls were not aligned
  std::vector<DrawnComponent> drawn{};
  std::vector<SweepVerdict> sweeps{};  ///< one for each session, if deskewing was asked for
};

/// Returns one JSON object; docs/cli.md describes its members. Numbers that are not finite (a pose that does not exist)
/// become null.
std::string json_report(const RunReport& report);

/// Returns the names and versions of the library and of its dependencies.
std::vector<std::pair<std::string, std::string>> component_versions();

}  // namespace shapemap
