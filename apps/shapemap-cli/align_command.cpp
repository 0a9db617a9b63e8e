// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>

#include "commands.hpp"
#include "console.hpp"
#include "costs.hpp"
#include "exit_codes.hpp"
#include "options_file.hpp"
#include "output_set.hpp"
#include "run_observer.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/io/pair_files.hpp"

namespace shapemap::cli {
namespace {

void check_paths(const AlignArguments& arguments) {
  for (const std::string& input :
       {arguments.log_path, arguments.other_path, arguments.pairs_path, arguments.config_path}) {
    if (!input.empty()) check_outputs({arguments.out_path}, input, arguments.force);
  }
}

std::vector<ScanPair> wanted_pairs(const AlignArguments& arguments, const Log& references, const Log& queries) {
  const std::size_t num_references = references.scans.size();
  if (arguments.gap == 0) return read_pairs(arguments.pairs_path, num_references, queries.scans.size());
  std::vector<ScanPair> pairs = pairs_with_gap(num_references, static_cast<std::size_t>(arguments.gap));
  if (pairs.empty()) {
    throw ConfigError("--gap " + std::to_string(arguments.gap) + " leaves no pair of " +
                      std::to_string(num_references) + " positions");
  }
  return pairs;
}

Log with_straight_sweeps(Log log, const AlignArguments& arguments) {
  const MappingOptions& options = arguments.settings.mapping;
  ConsoleObserver observer(!arguments.quiet);
  log = straightened(std::move(log), options.returns, options.deskew, arguments.settings.selection.every,
                     {options.run.threads, observer})
            .log;
  observer.finish();
  log.warnings.insert(log.warnings.end(), observer.warnings().begin(), observer.warnings().end());
  return log;
}

std::vector<AlignedPair> align_with_progress(const Log& references, const Log& queries,
                                             const std::vector<ScanPair>& pairs, const AlignArguments& arguments) {
  ConsoleObserver observer(!arguments.quiet, "pairs");
  std::vector<AlignedPair> aligned = align_pairs(references, queries, pairs, arguments.settings.mapping, observer);
  observer.finish();
  if (interrupted()) throw Interrupted();
  return aligned;
}

void print_summary(const AlignArguments& arguments, const std::vector<AlignedPair>& aligned, double wall_s) {
  const auto num_ok =
      std::count_if(aligned.begin(), aligned.end(), [](const AlignedPair& pair) { return pair.match.ok(); });
  char text[120];
  std::snprintf(text, sizeof text, "aligned %zu pairs in %.1f s, %td of them ok; written: ", aligned.size(), wall_s,
                num_ok);
  print_line(text + (arguments.out_path == "-" ? "standard output" : arguments.out_path));
}

}  // namespace

int run_align(const AlignArguments& arguments) {
  const Stopwatch total;
  MapSettings settings = arguments.settings;
  if (arguments.dump_config) {
    print_text(options_file_text(align_option_table(settings)));
    return kExitOk;
  }
  check_paths(arguments);
  const auto read = [&](const std::string& path) {
    Log log = select_scans(read_log(path, arguments.format, settings.reading), settings.selection);
    return with_straight_sweeps(std::move(log), arguments);
  };
  const Log log = read(arguments.log_path);
  const Log other = arguments.other_path.empty() ? Log{} : read(arguments.other_path);
  const Log& queries = arguments.other_path.empty() ? log : other;
  const std::vector<ScanPair> pairs = wanted_pairs(arguments, log, queries);

  set_interrupt_policy(OnInterrupt::kFinishStep);
  const std::vector<AlignedPair> aligned = align_with_progress(log, queries, pairs, arguments);
  std::string lines;
  for (const AlignedPair& pair : aligned) lines += json_line(pair, arguments.timings);
  OutputSet outputs(arguments.force);
  outputs.add_text(arguments.out_path, lines);
  outputs.commit();

  if (!arguments.quiet) {
    print_lines("warning: ", log.warnings, kMaxListed, "");
    print_lines("warning: ", other.warnings, kMaxListed, "");
    print_summary(arguments, aligned, total.seconds());
  }
  return kExitOk;
}

}  // namespace shapemap::cli
