// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace shapemap::cli {

/// The name begins every line that the program prints about itself. Each program defines its own.
extern const char* const kProgramName;

/// Calls `run` with the arguments after the program's name and returns the exit code; failures become one line on
/// stderr.
int run_program(int argc, char** argv, int (*run)(const std::vector<std::string>& typed));

}  // namespace shapemap::cli
