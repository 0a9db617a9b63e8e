// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_outputs.hpp"

#include "map_picture.hpp"
#include "shapemap/io/grid_map.hpp"
#include "shapemap/io/map_files.hpp"
#include "shapemap/io/trajectory_files.hpp"
#include "signals.hpp"

namespace shapemap::cli {
namespace {

/// The positions that have a pose, and only those.
Log placed_log(const Log& log, const std::vector<PlacedPosition>& placed, LogPoses& poses) {
  Log part;
  part.format = log.format;
  for (const PlacedPosition& place : placed) {
    part.positions.push_back(log.positions.at(place.position_index));
    poses.map_from_robot.push_back(place.map_from_robot);
  }
  return part;
}

void add_logs(const MapArguments& arguments, const Log& log, const std::vector<PlacedPosition>& placed,
              OutputSet& outputs) {
  if (arguments.carmen_path.empty() && arguments.rawlog_path.empty()) return;
  LogPoses poses;
  const Log part = placed_log(log, placed, poses);
  const auto add = [&](const std::string& to, LogFormat format) {
    if (to.empty()) return;
    outputs.add(to, [&](const std::string& path) { write_log(part, path, format, &poses); });
  };
  add(arguments.carmen_path, LogFormat::kCarmen);
  add(arguments.rawlog_path, LogFormat::kRawlog);
}

}  // namespace

std::vector<std::string> output_paths(const MapArguments& arguments) {
  std::vector<std::string> paths{arguments.map_path, ros_yaml_path(arguments.map_path)};
  for (const std::string& path : {arguments.trajectory_path, arguments.motions_path, arguments.carmen_path,
                                  arguments.rawlog_path, arguments.report_path, arguments.trace_path}) {
    if (!path.empty()) paths.push_back(path);
  }
  return paths;
}

void prepare_outputs(const MapArguments& arguments, const Log& log, const MapResult& result, OutputSet& outputs) {
  const std::vector<PlacedPosition>& placed = result.placed();
  set_interrupt_policy(OnInterrupt::kExitAtOnce);  // nothing is open yet, and a large map takes a while
  const GridMap map = build_grid_map(log, placed, arguments.settings.mapping.returns, arguments.settings.grid);
  set_interrupt_policy(OnInterrupt::kFinishStep);
  add_map(arguments.map_path, map, arguments.settings.drawing.draw_path ? &placed : nullptr, outputs);
  add_logs(arguments, log, placed, outputs);
  if (!arguments.trajectory_path.empty()) outputs.add_text(arguments.trajectory_path, tum_trajectory(placed));
  if (!arguments.motions_path.empty()) outputs.add_text(arguments.motions_path, motion_lines(motions_of(result)));
}

}  // namespace shapemap::cli
