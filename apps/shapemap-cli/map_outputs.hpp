// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "arguments.hpp"
#include "output_set.hpp"
#include "shapemap/io/report.hpp"

namespace shapemap::cli {

/// All files that a run with `arguments` writes.
std::vector<std::string> output_paths(const MapArguments& arguments);

/// Draws the map and prepares the files that were asked for, except the trace, which is
/// written while mapping, and the report, which is made last.
void prepare_outputs(const MapArguments& arguments, const Log& log, const MapResult& result, OutputSet& outputs);

}  // namespace shapemap::cli
