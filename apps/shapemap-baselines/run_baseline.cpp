// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_baseline.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

#include "console.hpp"
#include "costs.hpp"
#include "exit_codes.hpp"
#include "map_picture.hpp"
#include "run_observer.hpp"
#include "run_program.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/io/map_files.hpp"

namespace shapemap::baselines {
namespace {

std::vector<std::string> output_paths(const Arguments& arguments) {
  std::vector<std::string> paths{arguments.trajectory_path};
  if (arguments.map_path.empty()) return paths;
  paths.push_back(arguments.map_path);
  paths.push_back(cli::ros_yaml_path(arguments.map_path));
  return paths;
}

void check_paths(const Arguments& arguments) {
  for (const std::string& input :
       {arguments.log_path, arguments.motions.poses_path, arguments.motions.covariances_path}) {
    if (!input.empty()) cli::check_outputs(output_paths(arguments), input, arguments.force);
  }
}

/// Drops the readings that shapemap takes for no returns, so that the other methods see the same. Beams that hit
/// nothing stay distinct from those whose reading means nothing, for the picture.
void drop_non_returns(Log& log, const ReturnOptions& options) {
  for (Scan& scan : log.scans) {
    for (Sweep& sweep : scan.sweeps) {
      const RangeLimits limits = range_limits(sweep, options);
      for (float& range_m : sweep.ranges_m) {
        if (is_return(range_m, limits)) continue;
        range_m = is_open(range_m, limits) ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
      }
    }
  }
}

/// Returns the poses of the scans that were placed before time or memory ended, in the frame of the first.
std::vector<PlacedScan> place_all(const Log& log, const std::vector<Motion>& motions, const Arguments& arguments,
                                  std::vector<std::string>& warnings) {
  const std::unique_ptr<SlamMethod> method = make_method(arguments.method, arguments.settings);
  cli::ConsoleObserver observer(!arguments.quiet);
  const Stopwatch stopwatch;
  const double max_s = arguments.settings.run.max_seconds;
  const std::size_t num_scans = log.scans.size();
  for (std::size_t i = 0; i < num_scans; ++i) {
    if (!observer.keep_going()) throw Interrupted();
    const bool late = max_s > 0.0 && stopwatch.seconds() > max_s;
    std::string why = late ? "--max-seconds is over" : "";
    try {
      if (!late) method->add(log.scans[i], motions[i]);
    } catch (const CannotGoOn& e) {
      why = e.what();
    }
    if (!why.empty()) {
      warnings.push_back(std::to_string(num_scans - i) + " of " + std::to_string(num_scans) +
                         " positions are not placed: " + why);
      break;
    }
    observer.on_progress(i + 1, num_scans);
  }
  observer.finish();

  std::vector<PlacedScan> placed;
  for (const Pose2& pose : method->map_from_robot()) {
    const Scan& scan = log.scans[placed.size()];
    placed.push_back({placed.size(), scan.timestamp_s, pose, std::vector<Pose2>(scan.sweeps.size())});
  }
  if (placed.empty()) throw InputError(arguments.log_path + ": no position could be placed; nothing written");
  const Pose2 first_from_map = inverse(placed.front().map_from_robot);
  for (PlacedScan& place : placed) place.map_from_robot = first_from_map * place.map_from_robot;
  return placed;
}

void write_outputs(const Arguments& arguments, const Log& log, const std::vector<PlacedScan>& placed) {
  cli::OutputSet outputs(arguments.force);
  if (!arguments.map_path.empty()) {
    cli::set_interrupt_policy(cli::OnInterrupt::kExitAtOnce);  // nothing is open yet
    const OccupancyGrid map =
        build_occupancy_grid(log.scans, placed, arguments.settings.returns, arguments.settings.grid);
    cli::set_interrupt_policy(cli::OnInterrupt::kFinishStep);
    cli::add_map(arguments.map_path, map, nullptr, outputs);
    if (map.num_outside > 0 && !arguments.quiet) {
      std::fprintf(stderr, "%s: %zu of %zu returns lie outside of the picture; --draw-all draws them\n",
                   cli::kProgramName, map.num_outside, map.num_returns);
    }
  }
  outputs.add_text(arguments.trajectory_path, tum_trajectory(placed));
  outputs.commit();
}

void print_summary(const Arguments& arguments, const Log& log, const std::vector<PlacedScan>& placed, double wall_s) {
  std::string written;
  for (const std::string& path : output_paths(arguments)) {
    written += (written.empty() ? "" : ", ") + (path == "-" ? "standard output" : path);
  }
  char costs[80];
  std::snprintf(costs, sizeof costs, " positions in %.1f s, %.0f MiB; written: ", wall_s, cli::peak_memory_mib());
  cli::print_line(enum_name(arguments.method) + " placed " + std::to_string(placed.size()) + " of " +
                  std::to_string(log.scans.size()) + costs + written);
}

int run(const Arguments& arguments) {
  const Stopwatch total;
  const BaselineSettings& settings = arguments.settings;
  check_paths(arguments);
  Log log = read_log(arguments.log_path, arguments.format, settings.reading);
  const std::vector<Motion> motions = motions_for(log, settings.selection, arguments.motions, settings.motion);
  log = select_scans(std::move(log), settings.selection);
  drop_non_returns(log, settings.returns);
  std::vector<std::string> warnings = log.warnings;

  cli::set_interrupt_policy(cli::OnInterrupt::kFinishStep);
  const std::vector<PlacedScan> placed = place_all(log, motions, arguments, warnings);
  write_outputs(arguments, log, placed);
  if (!arguments.quiet) {
    cli::print_lines("warning: ", warnings, cli::kMaxListed, "");
    print_summary(arguments, log, placed, total.seconds());
  }
  return placed.size() == log.scans.size() ? cli::kExitOk : cli::kExitIncomplete;
}

}  // namespace

std::unique_ptr<SlamMethod> make_method(BaselineMethod method, const BaselineSettings& settings) {
  switch (method) {
    case BaselineMethod::kMrptIcp:
      return make_mrpt_icp(settings.icp, settings.returns);
    case BaselineMethod::kMrptRbpf:
      return make_mrpt_rbpf(settings.rbpf, settings.run.seed);
    case BaselineMethod::kVasco:
      return make_vasco(settings.vasco, settings.returns);
  }
  throw ConfigError("no such method");
}

int run_command_line(const std::vector<std::string>& typed) {
  const std::optional<Arguments> arguments = parse_arguments(typed);
  return arguments ? run(*arguments) : cli::kExitOk;
}

}  // namespace shapemap::baselines
