// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "console.hpp"
#include "exit_codes.hpp"
#include "output_set.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/io/log_file.hpp"
#include "signals.hpp"

namespace shapemap::cli {

int run_convert(const ConvertArguments& arguments) {
  check_outputs({arguments.out_path}, arguments.in_path, arguments.force);
  Log log = read_log(arguments.in_path, arguments.from, arguments.reading);

  set_interrupt_policy(OnInterrupt::kFinishStep);
  OutputSet outputs(arguments.force);
  outputs.add(arguments.out_path, [&](const std::string& path) { write_log(log, path, arguments.to); });
  outputs.commit();
  if (const std::string lost = what_is_lost(log, arguments.to); !lost.empty()) log.warnings.push_back(lost);
  print_lines("warning: ", log.warnings, kMaxListed, "");
  return kExitOk;
}

}  // namespace shapemap::cli
