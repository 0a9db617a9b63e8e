// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "arguments.hpp"
#include "shapemap/io/match_cache_file.hpp"

/// --save-state and --resume: what was aligned survives the end of the run.
namespace shapemap::cli {

/// Finds out before the log is read what opening would find out later.
void check_state(const MapArguments& arguments);

/// Null when no state is wanted. Adds to `warnings` what is wrong with the file.
std::unique_ptr<MatchCacheFile> open_state(const MapArguments& arguments, const Log& log,
                                           std::vector<std::string>& warnings);

/// How much of the work the state had; nothing is printed unless the run was resumed.
void print_resumed(const MapArguments& arguments, const MatchCacheFile* state);

}  // namespace shapemap::cli
