// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_baseline.hpp"
#include "run_program.hpp"

const char* const shapemap::cli::kProgramName = "shapemap-baselines";

int main(int argc, char** argv) {
  return shapemap::cli::run_program(argc, argv, shapemap::baselines::run_command_line);
}
