// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "arguments.hpp"
#include "shapemap/io/match_cache_file.hpp"

/// With --save-state and --resume, matches survive the end of a run.
namespace shapemap::cli {

/// Finds out before the log is read what opening the state would find out later.
void check_state(const MapArguments& arguments);

/// Opens the state; null when none is wanted. Adds to `warnings` what is wrong with the file.
std::unique_ptr<MatchCacheFile> open_state(const MapArguments& arguments, const Log& log,
                                           std::vector<std::string>& warnings);

/// Prints how much of the work the state had, if the run was resumed.
void print_resumed(const MapArguments& arguments, const MatchCacheFile* state);

}  // namespace shapemap::cli
