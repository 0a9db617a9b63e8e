// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arguments.hpp"
#include "log_set.hpp"
#include "shapemap/deskew/deskew.hpp"
#include "shapemap/io/report.hpp"

/// These functions print the results of a run on the console.
namespace shapemap::cli {

/// Notes on a map beside the poses.
struct MapNotes {
  std::vector<WallDirection> walls;   ///< one for each component; empty when walls were not aligned
  std::vector<DrawnComponent> drawn;  ///< the map comes first
};

/// The results of a run that the summary tells.
struct RunOutcome {
  const MapResult& result;
  const MapNotes& notes;
  const std::vector<std::string>& warnings;
  const RunCosts& costs;
};

/// Returns a line for each scan that has no place in the map.
std::vector<std::string> unplaced_lines(const LogSet& logs, const MapResult& result);

/// Prints what was done about bent sweeps.
void print_sweeps(const MapArguments& arguments, const LogSet& logs, const std::vector<SweepVerdict>& sweeps);

/// Prints after mapping, before the map is written.
void print_interrupted(const LogSet& logs, const MapResult& result);

/// Prints the whole summary once the map is written.
void print_summary(const MapArguments& arguments, const LogSet& logs, const RunOutcome& outcome);

}  // namespace shapemap::cli
