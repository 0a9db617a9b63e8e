// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "console.hpp"
#include "exit_codes.hpp"
#include "shapemap/io/log_file.hpp"

namespace shapemap::cli {

int run_info(const InfoArguments& arguments) {
  const Log log = read_log(arguments.log_path, arguments.format, arguments.reading);
  print_text("log         " + printable(arguments.log_path) + "\n" + log_summary_text(summarise(log)));
  print_lines("warning: ", log.warnings, log.warnings.size());
  return kExitOk;
}

}  // namespace shapemap::cli
