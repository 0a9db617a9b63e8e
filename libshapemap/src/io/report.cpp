// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/report.hpp"

#include <cmath>

#include "json_parts.hpp"

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

Json options_json(const RunReport& report) {
  Json all = Json::object();
  add_options(report.reading, all);
  add_options(report.selection, all);
  MappingOptions::groups(report.mapping, [&](const char*, const auto& group) { add_options(group, all); });
  add_options(report.grid, all);
  return all;
}

Json log_json(const RunReport& report) {
  const LogSummary summary = summarise(report.log);
  Json sensors = Json::array();
  for (const LogSummary::Sensor& sensor : summary.sensors) {
    sensors.push_back({{"label", sensor.label},
                       {"num_sub_scans", sensor.num_sub_scans},
                       {"num_beams", sensor.num_beams},
                       {"fov_deg", sensor.fov_rad / kDegree},
                       {"max_range_m", sensor.max_range_m},
                       {"shortest_return_m", sensor.shortest_return_m},
                       {"longest_return_m", sensor.longest_return_m},
                       {"return_ratio", sensor.return_ratio}});
  }
  return {{"path", report.log_path},
          {"format", summary.format},
          {"num_positions", summary.num_positions},
          {"duration_s", summary.duration_s},
          {"sensors", sensors}};
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

Json alignment_json(const PositionResult& position) {
  if (!was_aligned(position)) return nullptr;
  const Alignment& alignment = position.alignment;
  const auto if_any = [&](const Pose2& pose) { return alignment.has_pose() ? pose_json(pose) : Json(nullptr); };
  return {{"status", enum_name(alignment.status)},
          {"ref_from_query", if_any(alignment.ref_from_query)},
          {"shape_ref_from_query", if_any(alignment.shape_ref_from_query)},
          {"icp_ref_from_query", if_any(alignment.icp_ref_from_query)},
          {"probability", number_json(alignment.probability)},
          {"covariance", covariance_json(alignment.covariance)},
          {"ranked", ranked_json(alignment.ranked)},
          {"rotation_deg", alignment.rotation_rad / kDegree},
          {"num_correspondences", alignment.num_correspondences},
          {"mean_distance_m", alignment.mean_distance_m},
          {"overlap", alignment.overlap},
          {"overlap_ratio", alignment.overlap_ratio},
          {"icp_iterations", alignment.icp_iterations},
          {"query_from_sub_scan", poses_json(alignment.query_from_sub_scan)}};
}

Json position_json(const PositionResult& position, const RunReport& report) {
  return {{"index", position.position_index},
          {"index_in_whole_log", index_in_whole_log(position.position_index, report.selection)},
          {"timestamp_s", position.timestamp_s},
          {"fragment", position.fragment},
          {"starts_fragment", position.starts_fragment},
          {"reason", position.reason},
          {"alignment", alignment_json(position)},
          {"why_not_in_map", report.result.why_not_in_map(position)},
          {"map_from_robot", nullptr}};
}

Json positions_json(const RunReport& report) {
  Json list = Json::array();
  std::vector<std::size_t> entry_of(report.log.positions.size(), 0);
  for (const PositionResult& position : report.result.positions) {
    entry_of.at(position.position_index) = list.size();
    list.push_back(position_json(position, report));
  }
  for (const PlacedPosition& place : report.result.placed()) {
    list.at(entry_of.at(place.position_index))["map_from_robot"] = pose_json(place.map_from_robot);
  }
  return list;
}

Json fragments_json(const MapResult& result) {
  Json list = Json::array();
  for (std::size_t i = 0; i < result.fragments.size(); ++i) {
    const std::vector<PlacedPosition>& positions = result.fragments[i].positions;
    if (positions.empty()) continue;
    list.push_back({{"fragment", i},
                    {"num_positions", positions.size()},
                    {"first_index", positions.front().position_index},
                    {"last_index", positions.back().position_index},
                    {"is_map", static_cast<int>(i) == result.largest_fragment}});
  }
  return list;
}

Json timings_json(const RunReport& report) {
  const StageTimes& times = report.result.times;
  const RunCosts& costs = report.costs;
  return {{"shape", times.shape_s}, {"align", times.align_s},
          {"icp", times.icp_s},     {"decoupled_icp", times.decoupled_icp_s},
          {"read", costs.read_s},   {"map", costs.map_s},
          {"write", costs.write_s}, {"wall", costs.wall_s},
          {"cpu", costs.cpu_s}};
}

}  // namespace

std::string json_report(const RunReport& report) {
  Json versions = Json::object();
  for (const auto& [name, version] : component_versions()) versions[name] = version;
  const Json all = {{"format", "shapemap-report"},
                    {"format_version", 1},
                    {"versions", versions},
                    {"log", log_json(report)},
                    {"options", options_json(report)},
                    {"num_positions", report.result.positions.size()},
                    {"num_placed", report.result.placed().size()},
                    {"fragments", fragments_json(report.result)},
                    {"positions", positions_json(report)},
                    {"warnings", report.warnings},
                    {"seconds", timings_json(report)},
                    {"peak_memory_mib", report.costs.peak_memory_mib}};
  // Names in a log may hold any bytes; those that are no UTF-8 are replaced rather than fatal.
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace shapemap
