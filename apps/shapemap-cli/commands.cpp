// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

#include "exit_codes.hpp"

namespace shapemap::cli {

int run_command_line(const std::vector<std::string>& typed) {
  const std::string command = typed.empty() ? "" : typed.front();
  if (command == "info") {
    const auto arguments = parse_info_arguments({typed.begin() + 1, typed.end()});
    return arguments ? run_info(*arguments) : kExitOk;
  }
  if (command == "convert") {
    const auto arguments = parse_convert_arguments({typed.begin() + 1, typed.end()});
    return arguments ? run_convert(*arguments) : kExitOk;
  }
  if (command == "numbers") {
    return parse_numbers_arguments({typed.begin() + 1, typed.end()}) ? run_numbers() : kExitOk;
  }
  if (command == "align") {
    const auto arguments = parse_align_arguments({typed.begin() + 1, typed.end()});
    return arguments ? run_align(*arguments) : kExitOk;
  }
  const auto arguments = parse_map_arguments(typed);
  return arguments ? run_map(*arguments) : kExitOk;
}

}  // namespace shapemap::cli
