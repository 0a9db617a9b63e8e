// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
#include "console.hpp"
#include "costs.hpp"
#include "exit_codes.hpp"
#include "log_set.hpp"
#include "map_outputs.hpp"
#include "options_file.hpp"
#include "run_observer.hpp"
#include "run_summary.hpp"
#include "saved_state.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/io/trace_file.hpp"
#include "shapemap/mapper/map_log.hpp"

namespace shapemap::cli {
namespace {

struct MapRun {
  MapResult result;
  MapNotes notes;
};

void require_a_map(const MapArguments& arguments, const MapResult& result, const std::vector<std::string>& warnings) {
  if (!result.placed().empty()) return;
  const std::string more =
      arguments.logs.size() > 1 ? " and " + std::to_string(arguments.logs.size() - 1) + " more" : "";
  std::string why = "'" + arguments.logs.front().path + "'" + more + ": none of " + (more.empty() ? "its " : "their ") +
                    std::to_string(result.scans.size()) + " positions can be placed; nothing written";
  if (!result.scans.empty()) why += " (the first: " + result.scans.front().reason + ")";
  if (!warnings.empty()) why += "; " + warnings.front();
  throw InputError(why);
}

MapRun map_with_progress(const LogSet& logs, const MapArguments& arguments, MappingEvents* trace,
                         std::vector<std::string>& warnings, RunCosts& costs) {
  ConsoleObserver observer(arguments.verbosity != Verbosity::kQuiet);
  const std::unique_ptr<MatchCacheFile> state = open_state(arguments, logs.log, warnings);
  print_resumed(arguments, state.get());
  MapRun run;
  MapResult& result = run.result;
  std::vector<MappingEvents*> listeners{&observer};
  if (trace) listeners.push_back(trace);
  EventFanOut events(std::move(listeners));
  result = map_log(logs.log, arguments.settings.mapping, events, state.get());
  observer.finish();
  if (interrupted() && result.placed().empty()) throw Interrupted();
  if (result.interrupted) print_interrupted(logs, result);
  warnings.insert(warnings.end(), observer.warnings().begin(), observer.warnings().end());
  costs.milestones = observer.milestones();
  if (arguments.settings.walls.align_walls) {
    run.notes.walls = align_walls(logs.log.scans, arguments.settings.mapping.returns, result.components);
  }
  return run;
}

/// Straightens the sweeps, which from here on are as if all beams of one had been sent at once.
std::vector<SweepVerdict> straighten(const MapArguments& arguments, LogSet& logs, std::vector<std::string>& warnings) {
  const MappingOptions& options = arguments.settings.mapping;
  ConsoleObserver observer(arguments.verbosity != Verbosity::kQuiet);
  StraightenedLog straight = straightened(std::move(logs.log), options.returns, options.deskew,
                                          arguments.settings.selection.every, {options.run.threads, observer});
  logs.log = std::move(straight.log);
  observer.finish();
  warnings.insert(warnings.end(), observer.warnings().begin(), observer.warnings().end());
  return straight.verdicts;
}

/// Maps the logs, and writes the trace meanwhile if one is wanted.
MapRun map_and_trace(const LogSet& logs, const MapArguments& arguments, std::vector<std::string>& warnings,
                     RunCosts& costs, OutputSet& outputs) {
  if (arguments.trace_path.empty()) return map_with_progress(logs, arguments, nullptr, warnings, costs);
  const MapSettings& settings = arguments.settings;
  std::vector<std::string> paths;
  for (const LogSource& log : arguments.logs) paths.push_back(log.path);
  MapRun run;
  outputs.add(arguments.trace_path, [&](const std::string& path) {
    TraceFile trace(path, {paths, logs.log, settings.mapping, settings.reading, settings.selection});
    run = map_with_progress(logs, arguments, &trace, warnings, costs);
    trace.commit(run.result);
  });
  return run;
}

int exit_code(const LogSet& logs, const MapResult& result, bool was_interrupted) {
  if (was_interrupted) return kExitInterrupted;
  return unplaced_lines(logs, result).empty() ? kExitOk : kExitIncomplete;
}

}  // namespace

int run_map(const MapArguments& arguments) {
  const Stopwatch total;
  MapSettings settings = arguments.settings;
  if (arguments.dump_config) {
    print_text(options_file_text(option_table(settings)));
    return kExitOk;
  }
  check_output_paths(arguments);
  check_state(arguments);
  LogSet logs = read_logs(arguments);
  RunCosts costs;
  costs.read_s = total.seconds();
  std::vector<std::string> warnings = logs.log.warnings;

  set_interrupt_policy(OnInterrupt::kFinishStep);
  const Stopwatch mapping;
  const std::vector<SweepVerdict> sweeps = straighten(arguments, logs, warnings);
  OutputSet outputs(arguments.force);
  MapRun run = map_and_trace(logs, arguments, warnings, costs, outputs);
  const MapResult& result = run.result;
  costs.map_s = mapping.seconds();
  require_a_map(arguments, result, warnings);

  const Stopwatch writing;
  run.notes.drawn = prepare_outputs(arguments, logs, result, outputs);
  costs.write_s = writing.seconds();
  costs.wall_s = total.seconds();
  costs.cpu_s = cpu_seconds();
  costs.peak_memory_mib = peak_memory_mib();
  if (!arguments.report_path.empty()) {
    outputs.add_text(
        arguments.report_path,
        json_report({logs.files, logs.log, result, settings.mapping, settings.reading, settings.selection,
                     settings.grid, warnings, costs, settings.walls, run.notes.walls, run.notes.drawn, sweeps}));
  }
  outputs.commit(IfInterrupted::kWriteAll);
  const bool was_interrupted = interrupted();  // what is printed and the exit code agree, whatever signal comes now
  if (was_interrupted && !result.interrupted) print_lines("", {"interrupted while writing; the map is whole"}, 1);
  print_sweeps(arguments, logs, sweeps);
  print_summary(arguments, logs, {result, run.notes, warnings, costs});
  return exit_code(logs, result, was_interrupted);
}

}  // namespace shapemap::cli
