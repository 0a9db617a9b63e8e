// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>

#include "commands.hpp"
#include "console.hpp"
#include "costs.hpp"
#include "exit_codes.hpp"
#include "map_outputs.hpp"
#include "options_file.hpp"
#include "run_observer.hpp"
#include "saved_state.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/io/trace_file.hpp"
#include "shapemap/map/map_log.hpp"

namespace shapemap::cli {
namespace {

std::vector<std::string> unplaced_lines(const MapResult& result, const SelectionOptions& selection) {
  std::vector<std::string> lines;
  for (const PositionResult& position : result.positions) {
    const std::string why = result.why_not_in_map(position);
    if (why.empty()) continue;
    const std::size_t index = index_in_whole_log(position.position_index, selection);
    lines.push_back("position " + std::to_string(index) + " not placed: " + why);
  }
  return lines;
}

/// What makes the map though it may be wrong.
bool is_uncertain(const PositionResult& position) {
  return position.fragment >= 0 && !position.starts_fragment && !position.alignment.ok();
}

std::vector<std::string> uncertain_lines(const MapResult& result, const SelectionOptions& selection) {
  std::vector<std::string> lines;
  for (const PositionResult& position : result.positions) {
    if (!is_uncertain(position)) continue;
    const std::size_t index = index_in_whole_log(position.position_index, selection);
    lines.push_back("position " + std::to_string(index) + " " + enum_name(position.alignment.status) + ": " +
                    position.alignment.reason);
  }
  return lines;
}

void print_uncertain(const MapResult& result) {
  std::size_t aligned = 0;
  std::size_t too_apart = 0;
  std::size_t ambiguous = 0;
  std::size_t degenerate = 0;
  for (const PositionResult& position : result.positions) {
    if (position.fragment >= 0 && !position.starts_fragment) ++aligned;
    if (!is_uncertain(position)) continue;
    const AlignStatus status = position.alignment.status;
    ++(status == AlignStatus::kAmbiguous ? ambiguous : status == AlignStatus::kDegenerate ? degenerate : too_apart);
  }
  const std::size_t uncertain = too_apart + ambiguous + degenerate;
  if (uncertain == 0) return;
  std::fprintf(stderr,
               "shapemap-cli: %zu of %zu alignments are uncertain: %zu with too little overlap, %zu ambiguous, "
               "%zu degenerate\n",
               uncertain, aligned, too_apart, ambiguous, degenerate);
}

void require_a_map(const MapArguments& arguments, const MapResult& result) {
  if (!result.placed().empty()) return;
  std::string why = "'" + arguments.log_path + "': none of its " + std::to_string(result.positions.size()) +
                    " positions can be placed; nothing written";
  if (!result.positions.empty()) why += " (the first: " + result.positions.front().reason + ")";
  throw InputError(why);
}

void print_summary(const MapArguments& arguments, const MapResult& result, double wall_s) {
  std::fprintf(stderr, "shapemap-cli: placed %zu of %zu positions (%zu fragment%s) in %.1f s; map: %s\n",
               result.placed().size(), result.positions.size(), result.fragments.size(),
               result.fragments.size() == 1 ? "" : "s", wall_s, arguments.map_path.c_str());
}

void print_details(const Log& log, const RunCosts& costs, const StageTimes& times) {
  std::fputs(log_summary_text(summarise(log)).c_str(), stderr);
  std::fprintf(
      stderr,
      "seconds     read %.2f, map %.2f (shapes %.2f, alignment %.2f, ICP %.2f, decoupled ICP %.2f), write %.2f\n"
      "memory      %.0f MiB\n",
      costs.read_s, costs.map_s, times.shape_s, times.align_s, times.icp_s, times.decoupled_icp_s, costs.write_s,
      costs.peak_memory_mib);
}

MapResult map_with_progress(const Log& log, const MapArguments& arguments, TraceSink* sink,
                            std::vector<std::string>& warnings) {
  ConsoleObserver observer(arguments.verbosity != Verbosity::kQuiet);
  const std::unique_ptr<AlignmentStoreFile> state = open_state(arguments, log, warnings);
  print_resumed(arguments, state.get());
  MapResult result = map_log(log, arguments.settings.mapping, observer, sink, state.get());
  observer.finish();
  if (result.interrupted || interrupted()) throw Interrupted();
  warnings.insert(warnings.end(), observer.warnings().begin(), observer.warnings().end());
  return result;
}

/// Maps the log, and writes the trace meanwhile if one is wanted.
MapResult map_and_trace(const Log& log, const MapArguments& arguments, std::vector<std::string>& warnings,
                        OutputSet& outputs) {
  if (arguments.trace_path.empty()) return map_with_progress(log, arguments, nullptr, warnings);
  const MapSettings& settings = arguments.settings;
  MapResult result;
  outputs.add(arguments.trace_path, [&](const std::string& path) {
    TraceFile trace(path, {arguments.log_path, log, settings.mapping, settings.reading, settings.selection});
    result = map_with_progress(log, arguments, &trace, warnings);
    trace.commit(result);
  });
  return result;
}

void add_report(const MapArguments& arguments, const RunReport& report, OutputSet& outputs) {
  if (!arguments.report_path.empty()) outputs.add_text(arguments.report_path, json_report(report));
}

}  // namespace

int run_map(const MapArguments& arguments) {
  const Stopwatch total;
  MapSettings settings = arguments.settings;
  if (arguments.dump_config) {
    print_text(options_file_text(option_table(settings)));
    return kExitOk;
  }
  check_outputs(output_paths(arguments), arguments.log_path, arguments.force);
  check_state(arguments);
  const Log log =
      select_positions(read_log(arguments.log_path, arguments.format, settings.reading), settings.selection);
  RunCosts costs;
  costs.read_s = total.seconds();
  std::vector<std::string> warnings = log.warnings;

  set_interrupt_policy(OnInterrupt::kFinishStep);
  const Stopwatch mapping;
  OutputSet outputs;
  const MapResult result = map_and_trace(log, arguments, warnings, outputs);
  costs.map_s = mapping.seconds();
  require_a_map(arguments, result);

  const Stopwatch writing;
  prepare_outputs(arguments, log, result, outputs);
  costs.write_s = writing.seconds();
  costs.wall_s = total.seconds();
  costs.cpu_s = cpu_seconds();
  costs.peak_memory_mib = peak_memory_mib();
  add_report(arguments,
             {arguments.log_path, log, result, settings.mapping, settings.reading, settings.selection, settings.grid,
              warnings, costs},
             outputs);
  outputs.commit();

  const std::vector<std::string> unplaced = unplaced_lines(result, settings.selection);
  if (arguments.verbosity != Verbosity::kQuiet) {
    const bool verbose = arguments.verbosity == Verbosity::kVerbose;
    const std::size_t max_listed = verbose ? static_cast<std::size_t>(-1) : kMaxListed;
    print_lines("warning: ", warnings, max_listed);
    print_lines("", unplaced, max_listed);
    print_lines("", uncertain_lines(result, settings.selection), max_listed);
    if (verbose) print_details(log, costs, result.times);
    print_uncertain(result);
    print_summary(arguments, result, costs.wall_s);
  }
  return unplaced.empty() ? kExitOk : kExitIncomplete;
}

}  // namespace shapemap::cli
