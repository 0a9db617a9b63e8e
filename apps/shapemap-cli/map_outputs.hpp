// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "arguments.hpp"
#include "log_set.hpp"
#include "output_set.hpp"
#include "shapemap/io/report.hpp"

namespace shapemap::cli {

/// Returns the outputs that each log gets for itself: the option and its path.
std::vector<std::pair<const char*, std::string>> per_log_outputs(const MapArguments& arguments);

/// Returns all files of a run with `arguments`, but for those of --fragments and --save-state.
std::vector<std::string> output_paths(const MapArguments& arguments);

/// Returns the files that a run with `arguments` reads.
std::vector<std::string> input_paths(const MapArguments& arguments);

/// Checks that all outputs of a run with `arguments` can be written. Throws ConfigError and OutputError.
void check_output_paths(const MapArguments& arguments);

/// Draws the map and prepares the files that were asked for, except the trace, which is written while mapping, and the
/// report, which is made last. Returns what the pictures show.
std::vector<DrawnComponent> prepare_outputs(const MapArguments& arguments, const LogSet& logs, const MapResult& result,
                                            OutputSet& outputs);

}  // namespace shapemap::cli
