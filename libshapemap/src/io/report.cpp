// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/report.hpp"

#include <algorithm>
#include <cmath>

#include "json_parts.hpp"
#include "references.hpp"
#include "shapemap/scan/joined_logs.hpp"

namespace shapemap {
namespace {

bool is_finite(const Pose2& pose) {
  return std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.theta_rad);
}

Json pose_json(const Pose2& pose) {
  if (!is_finite(pose)) return nullptr;
  return {{"x_m", pose.x_m}, {"y_m", pose.y_m}, {"theta_deg", pose.theta_rad / kDegree}};
}

Json poses_json(const std::vector<Pose2>& poses) {
  Json list = Json::array();
  for (const Pose2& pose : poses) list.push_back(pose_json(pose));
  return list;
}

std::size_t num_inside(const std::vector<PlacedScan>& placed, const LogPart& part) {
  return static_cast<std::size_t>(std::count_if(placed.begin(), placed.end(), [&](const PlacedScan& place) {
    return part.first <= place.scan_index && place.scan_index < part.last;
  }));
}

std::size_t num_contradicting(const std::vector<PlacedScan>& placed) {
  return static_cast<std::size_t>(std::count_if(
      placed.begin(), placed.end(), [](const PlacedScan& place) { return place.consistency.contradicts_map; }));
}

Json options_json(const RunReport& report) {
  Json all = Json::object();
  add_options(report.reading, all);
  add_options(report.selection, all);
  MappingOptions::groups(report.mapping, [&](const char*, const auto& group) { add_options(group, all); });
  add_options(report.walls, all);
  add_options(report.grid, all);
  return all;
}

Json sweeps_json(const SweepVerdict& verdict) {
  return {{"straightened", verdict.straightened},       {"period_s", verdict.period_s},
          {"sweep_time_s", verdict.sweep_time_s},       {"told_by_log", verdict.told},
          {"num_judged", verdict.num_judged},           {"num_better", verdict.num_better},
          {"misfit_before_m", verdict.misfit_before_m}, {"misfit_after_m", verdict.misfit_after_m},
          {"num_sweeps", verdict.num_sweeps},           {"num_left", verdict.num_left},
          {"num_beams_twice", verdict.num_beams_twice}};
}

Json log_json(const RunReport& report, std::size_t which, const LogPart& part) {
  const LogSummary summary = summarise(report.log, part.first, part.last);
  Json sensors = Json::array();
  for (const LogSummary::Sensor& sensor : summary.sensors) {
    sensors.push_back({{"label", sensor.label},
                       {"num_sweeps", sensor.num_sweeps},
                       {"num_beams", sensor.most_beams},
                       {"fewest_beams", sensor.fewest_beams},
                       {"num_without_readings", sensor.num_without_readings},
                       {"num_without_returns", sensor.num_without_returns},
                       {"has_uneven_beams", sensor.has_uneven_beams},
                       {"is_upside_down", sensor.is_upside_down},
                       {"sweep_s", sensor.sweep_s},
                       {"fov_deg", sensor.fov_rad / kDegree},
                       {"max_range_m", sensor.max_range_m},
                       {"shortest_return_m", sensor.shortest_return_m},
                       {"longest_return_m", sensor.longest_return_m},
                       {"return_ratio", sensor.return_ratio}});
  }
  Json no_returns = Json::array();
  for (const NoReturnLevel& level : summary.no_returns) {
    no_returns.push_back({{"label", level.sensor_label},
                          {"from_m", level.from_m},
                          {"to_m", level.to_m},
                          {"num_readings", level.num_readings}});
  }
  const LogFile& file = report.logs.at(which);
  return {{"path", file.path},
          {"format", file.format},
          {"first_index", part.first},
          {"num_scans", summary.num_scans},
          {"num_placed", num_inside(report.result.placed(), part)},
          {"duration_s", summary.duration_s},
          {"sensors", sensors},
          {"no_returns", no_returns},
          {"sweeps", which < report.sweeps.size() ? sweeps_json(report.sweeps[which]) : Json(nullptr)}};
}

Json logs_json(const RunReport& report) {
  Json list = Json::array();
  for (const LogPart& part : parts_of(report.log)) list.push_back(log_json(report, list.size(), part));
  return list;
}

Json ranked_json(const std::vector<RankedPose>& ranked) {
  Json list = Json::array();
  for (const RankedPose& pose : ranked) {
    list.push_back({{"ref_from_query", pose_json(pose.ref_from_query)},
                    {"score", number_json(pose.score)},
                    {"agree", pose.agree},
                    {"crossed", pose.crossed}});
  }
  return list;
}

/// What only one of the two methods tells stands there for the other as well, empty.
Json match_json(const ScanResult& scan, std::size_t reference) {
  if (!scan.was_aligned()) return nullptr;
  const PaperAlignment paper = scan.paper.value_or(PaperAlignment());
  const std::vector<RankedPose>& ranked = scan.match.ranked;
  const double agree = ranked.empty() ? 0.0 : ranked.front().agree;
  const auto if_any = [&](const Pose2& pose) { return scan.has_pose() ? pose_json(pose) : Json(nullptr); };
  return {{"status", scan.status_text()},
          {"reference", reference == kNoReference ? Json(nullptr) : Json(reference)},
          {"ref_from_query", if_any(scan.ref_from_query())},
          {"shape_ref_from_query", if_any(paper.shape_ref_from_query)},
          {"icp_ref_from_query", if_any(paper.icp_ref_from_query)},
          {"probability", number_json(scan.match.probability)},
          {"covariance", covariance_json(scan.match.covariance)},
          {"ranked", ranked_json(ranked)},
          {"rotation_deg", paper.rotation_rad / kDegree},
          {"num_correspondences", paper.num_correspondences},
          {"mean_distance_m", paper.mean_distance_m},
          {"overlap", paper.overlap},
          {"overlap_ratio", scan.paper ? paper.overlap_ratio : agree},
          {"icp_iterations", paper.icp_iterations},
          {"query_from_sweep", poses_json(paper.query_from_sweep)}};
}

Json scan_json(const ScanResult& scan, std::size_t reference, const RunReport& report) {
  const std::size_t log = part_with(report.log, scan.scan_index);
  const std::size_t first = log == 0 ? 0 : report.log.starts[log - 1];
  return {{"index", scan.scan_index},
          {"log", log},
          {"index_in_whole_log", index_in_whole_log(scan.scan_index - first, report.selection)},
          {"timestamp_s", scan.timestamp_s},
          {"component", scan.component},
          {"starts_component", scan.starts_component},
          {"is_keyframe", scan.component >= 0 && scan.is_keyframe},
          {"loop_constrained", scan.loop_constrained},
          {"reason", scan.reason},
          {"alignment", match_json(scan, reference)},
          {"why_not_in_map", report.result.why_not_in_map(scan)},
          {"map_from_robot", nullptr},
          {"consistency", nullptr}};
}

Json consistency_json(const ScanConsistency& consistency) {
  return {{"agree", consistency.agree},
          {"through", consistency.through},
          {"in_free", consistency.in_free},
          {"contradicts_map", consistency.contradicts_map}};
}

Json scans_json(const RunReport& report) {
  Json list = Json::array();
  const std::vector<std::size_t> references = references_of(report.result);
  std::vector<std::size_t> entry_of(report.log.scans.size(), 0);
  for (const ScanResult& scan : report.result.scans) {
    entry_of.at(scan.scan_index) = list.size();
    list.push_back(scan_json(scan, references[list.size()], report));
  }
  for (const Component& component : report.result.components) {
    for (const PlacedScan& place : component.scans) {
      list.at(entry_of.at(place.scan_index))["consistency"] = consistency_json(place.consistency);
    }
  }
  for (const PlacedScan& place : report.result.placed()) {
    list.at(entry_of.at(place.scan_index))["map_from_robot"] = pose_json(place.map_from_robot);
  }
  return list;
}

/// Counts the scans of each session.
Json per_log_json(const Log& log, const std::vector<PlacedScan>& scans) {
  Json list = Json::array();
  const std::vector<LogPart> parts = parts_of(log);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t count = num_inside(scans, parts[i]);
    if (count > 0) list.push_back({{"log", i}, {"num_scans", count}});
  }
  return list;
}

Json drawn_json(const RunReport& report, std::size_t component) {
  for (const DrawnComponent& drawn : report.drawn) {
    if (drawn.component != static_cast<int>(component)) continue;
    return {{"num_returns", drawn.num_returns}, {"num_outside", drawn.num_outside}};
  }
  return nullptr;
}

Json walls_json(const RunReport& report, std::size_t component) {
  if (component >= report.wall_directions.size()) return nullptr;
  const WallDirection& walls = report.wall_directions[component];
  return {{"turned_deg", walls.turn_rad() / kDegree}, {"share", walls.share}, {"rival_share", walls.second_share}};
}

Json components_json(const RunReport& report) {
  const MapResult& result = report.result;
  Json list = Json::array();
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    const std::vector<PlacedScan>& scans = result.components[i].scans;
    if (scans.empty()) continue;
    list.push_back({{"component", i},
                    {"num_scans", scans.size()},
                    {"first_index", scans.front().scan_index},
                    {"last_index", scans.back().scan_index},
                    {"logs", per_log_json(report.log, scans)},
                    {"is_map", static_cast<int>(i) == result.largest_component},
                    {"picture", drawn_json(report, i)},
                    {"walls", walls_json(report, i)}});
  }
  return list;
}

Json loops_json(const MapResult& result) {
  Json list = Json::array();
  for (const ClosedLoop& loop : result.loops) {
    list.push_back({{"a", loop.a},
                    {"b", loop.b},
                    {"a_from_b", pose_json(loop.a_from_b)},
                    {"strength", number_json(loop.strength)}});
  }
  return list;
}

Json timings_json(const RunReport& report) {
  const StageTimes& times = report.result.times;
  const RunCosts& costs = report.costs;
  return {{"shape", times.shape_s}, {"align", times.align_s},
          {"icp", times.icp_s},     {"decoupled_icp", times.decoupled_icp_s},
          {"loops", times.loops_s}, {"consistency", times.consistency_s},
          {"read", costs.read_s},   {"map", costs.map_s},
          {"write", costs.write_s}, {"wall", costs.wall_s},
          {"cpu", costs.cpu_s}};
}

Json milestones_json(const RunCosts& costs) {
  Json list = Json::array();
  for (const Milestone& milestone : costs.milestones) {
    list.push_back({{"num_scans", milestone.num_scans},
                    {"wall_s", milestone.wall_s},
                    {"cpu_s", milestone.cpu_s},
                    {"peak_memory_mib", milestone.peak_memory_mib}});
  }
  return list;
}

}  // namespace

std::string json_report(const RunReport& report) {
  Json versions = Json::object();
  for (const auto& [name, version] : component_versions()) versions[name] = version;
  const Json all = {{"format", "shapemap-report"},
                    {"format_version", 3},
                    {"versions", versions},
                    {"logs", logs_json(report)},
                    {"options", options_json(report)},
                    {"num_scans", report.result.scans.size()},
                    {"num_placed", report.result.placed().size()},
                    {"num_contradicting", num_contradicting(report.result.placed())},
                    {"interrupted", report.result.interrupted},
                    {"components", components_json(report)},
                    {"loops", loops_json(report.result)},
                    {"scans", scans_json(report)},
                    {"warnings", report.warnings},
                    {"seconds", timings_json(report)},
                    {"milestones", milestones_json(report.costs)},
                    {"peak_memory_mib", report.costs.peak_memory_mib}};
  // Names in a log may hold any bytes; those that are no UTF-8 are replaced rather than fatal.
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace shapemap
