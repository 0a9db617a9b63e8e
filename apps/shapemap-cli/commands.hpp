// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "arguments.hpp"

/// Each command returns the exit code; all failures are exceptions.
namespace shapemap::cli {

int run_map(const MapArguments& arguments);
int run_info(const InfoArguments& arguments);
int run_convert(const ConvertArguments& arguments);
int run_align(const AlignArguments& arguments);
int run_numbers();

/// Runs the command that `typed` (without the program's name) asks for.
int run_command_line(const std::vector<std::string>& typed);

}  // namespace shapemap::cli
