// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_outputs.hpp"

#include "component_files.hpp"
#include "map_picture.hpp"
#include "shapemap/io/map_files.hpp"
#include "shapemap/io/trajectory_files.hpp"

namespace shapemap::cli {
namespace {

/// A part has the placed scans of one of the logs.
struct PlacedPart {
  std::size_t log;
  const std::vector<PlacedScan>& scans;
};

/// Returns a log of the scans that have a pose, and only those.
Log placed_log(const LogSet& logs, const PlacedPart& placed, LogPoses& poses) {
  Log part;
  part.format = logs.files.at(placed.log).format;
  for (const PlacedScan& place : placed.scans) {
    part.scans.push_back(logs.log.scans.at(place.scan_index));
    poses.map_from_robot.push_back(place.map_from_robot);
  }
  return part;
}

void add_log(const std::string& to, LogFormat format, const LogSet& logs, const PlacedPart& placed,
             OutputSet& outputs) {
  LogPoses poses;
  const Log part = placed_log(logs, placed, poses);
  outputs.add(to, [&](const std::string& path) { write_log(part, path, format, &poses); });
}

/// Calls `add(log index, path, placed scans of the log)` for each log, if `path` was given.
template <class Add>
void for_each_log(const std::string& path, const MapArguments& arguments, const LogSet& logs, const MapResult& result,
                  const Add& add) {
  if (path.empty()) return;
  const std::vector<std::string> paths = per_log_paths(path, arguments.logs);
  const std::vector<LogPart> parts = parts_of(logs.log);
  for (std::size_t i = 0; i < paths.size(); ++i) add(i, paths[i], placed_of(result.placed(), parts.at(i)));
}

}  // namespace

std::vector<std::pair<const char*, std::string>> per_log_outputs(const MapArguments& arguments) {
  std::vector<std::pair<const char*, std::string>> given;
  for (const auto& [option, path] :
       {std::pair{"--trajectory", arguments.trajectory_path}, std::pair{"--motions", arguments.motions_path},
        std::pair{"--carmen-out", arguments.carmen_path}, std::pair{"--rawlog-out", arguments.rawlog_path}}) {
    if (!path.empty()) given.emplace_back(option, path);
  }
  return given;
}

std::vector<std::string> output_paths(const MapArguments& arguments) {
  std::vector<std::string> paths{arguments.map_path, ros_yaml_path(arguments.map_path)};
  for (const std::string& path : {arguments.report_path, arguments.trace_path}) {
    if (!path.empty()) paths.push_back(path);
  }
  for (const auto& [option, path] : per_log_outputs(arguments)) {
    for (std::string& one : per_log_paths(path, arguments.logs)) paths.push_back(std::move(one));
  }
  return paths;
}

std::vector<std::string> input_paths(const MapArguments& arguments) {
  std::vector<std::string> paths;
  for (const LogSource& log : arguments.logs) paths.push_back(log.path);
  if (!arguments.config_path.empty()) paths.push_back(arguments.config_path);
  return paths;
}

void check_output_paths(const MapArguments& arguments) {
  std::vector<std::string> paths = output_paths(arguments);
  const std::vector<std::string> inputs = input_paths(arguments);
  for (const std::string& input : inputs) check_outputs(paths, input, arguments.force);
  if (arguments.fragments_folder.empty()) return;
  paths.insert(paths.end(), inputs.begin(), inputs.end());
  check_fragments_folder(arguments.fragments_folder, paths, arguments.force);
}

std::vector<DrawnComponent> prepare_outputs(const MapArguments& arguments, const LogSet& logs, const MapResult& result,
                                            OutputSet& outputs) {
  const std::vector<PlacedScan>& placed = result.placed();
  const MapSettings& settings = arguments.settings;
  const OccupancyGrid map = build_occupancy_grid(logs.log.scans, placed, settings.mapping.returns, settings.grid);
  std::vector<DrawnComponent> drawn{{result.largest_component, map.num_returns, map.num_outside}};
  add_map(arguments.map_path, map, settings.drawing.draw_path ? &placed : nullptr, outputs);
  const auto for_each = [&](const std::string& path, const auto& add) {
    for_each_log(path, arguments, logs, result, add);
  };
  for_each(arguments.carmen_path, [&](std::size_t which, const std::string& path, const auto& part) {
    add_log(path, LogFormat::kCarmen, logs, {which, part}, outputs);
  });
  for_each(arguments.rawlog_path, [&](std::size_t which, const std::string& path, const auto& part) {
    add_log(path, LogFormat::kRawlog, logs, {which, part}, outputs);
  });
  for_each(arguments.trajectory_path, [&](std::size_t, const std::string& path, const auto& part) {
    outputs.add_text(path, tum_trajectory(part));
  });
  for_each(arguments.motions_path, [&](std::size_t, const std::string& path, const auto& part) {
    outputs.add_text(path, motion_lines(motions_of(result, part)));
  });
  if (!arguments.fragments_folder.empty()) add_component_files(arguments, logs, result, outputs, drawn);
  return drawn;
}

}  // namespace shapemap::cli
