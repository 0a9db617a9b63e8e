// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "run_program.hpp"

const char* const shapemap::cli::kProgramName = "shapemap-cli";

int main(int argc, char** argv) { return shapemap::cli::run_program(argc, argv, shapemap::cli::run_command_line); }
