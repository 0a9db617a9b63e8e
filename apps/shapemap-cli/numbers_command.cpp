// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "exit_codes.hpp"
#include "shapemap/io/numbers.hpp"

namespace shapemap::cli {

bool parse_numbers_arguments(const std::vector<std::string>& typed) {
  CLI::App app(
      "All fitted weights and tolerances of the method as JSON, each with what it is and what it was fitted to.",
      "shapemap-cli numbers");
  app.footer("Examples:\n  shapemap-cli numbers\n  shapemap-cli numbers > numbers.json\n\n" + exit_code_help());
  return parse(app, typed);
}

int run_numbers() {
  print_text(method_numbers_json());
  return kExitOk;
}

}  // namespace shapemap::cli
