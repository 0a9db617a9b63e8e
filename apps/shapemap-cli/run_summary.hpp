// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arguments.hpp"
#include "log_set.hpp"
#include "shapemap/deskew/deskew.hpp"
#include "shapemap/io/report.hpp"

/// What a run says about itself on the console.
namespace shapemap::cli {

/// What is said of a map beside where its positions are.
struct MapNotes {
  std::vector<WallDirection> walls;   ///< of each fragment; empty when they were not asked for
  std::vector<DrawnComponent> drawn;  ///< the map's first
};

/// Positions that have no place in the map.
std::vector<std::string> unplaced_lines(const LogSet& logs, const MapResult& result);

/// What was done about bent sweeps.
void print_sweeps(const MapArguments& arguments, const LogSet& logs, const std::vector<SweepVerdict>& sweeps);

/// After mapping, before the map is written.
void print_interrupted(const LogSet& logs, const MapResult& result);

/// All of it, once the map is written.
void print_summary(const MapArguments& arguments, const LogSet& logs, const MapResult& result, const MapNotes& notes,
                   const std::vector<std::string>& warnings, const RunCosts& costs);

}  // namespace shapemap::cli
