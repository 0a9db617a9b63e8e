// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory_builder.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "edge_verdict.hpp"
#include "motion/trajectory_smoothing.hpp"

namespace shapemap {
namespace {

/// Returns the covariance of a match, turned into the frame of the map.
Eigen::Matrix3d covariance_in_map(const ScanMatch& match, const Pose2& map_from_robot) {
  Eigen::Matrix3d map_from_reference = Eigen::Matrix3d::Identity();
  const double heading_rad = map_from_robot.theta_rad - match.ref_from_query.theta_rad;
  map_from_reference.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(heading_rad).toRotationMatrix();
  return map_from_reference * match.covariance * map_from_reference.transpose();
}

class TrajectoryBuilder {
 public:
  TrajectoryBuilder(const SolvedGraph& solved, const std::vector<std::size_t>& num_sweeps,
                    const ConfidenceOptions& options, MappingEvents& events, MapResult& result)
      : graph_(solved.graph),
        map_(solved.map),
        sweeps_(solved.sweeps),
        num_sweeps_(num_sweeps),
        options_(options),
        events_(events),
        result_(result) {}

  void run() {
    for (std::size_t i = 0; i < graph_.keyframes.size(); ++i) place_keyframe(i);
    for (const AttachedScan& scan : graph_.attached) place_attached(scan);
    for (Component& component : result_.components) {
      std::sort(component.scans.begin(), component.scans.end(),
                [](const PlacedScan& a, const PlacedScan& b) { return a.scan_index < b.scan_index; });
      smooth(component);
      const Pose2 first_from_map = inverse(component.scans.front().map_from_robot);
      for (PlacedScan& placed : component.scans) placed.map_from_robot = first_from_map * placed.map_from_robot;
    }
  }

 private:
  void place_keyframe(std::size_t i) {
    ScanResult& outcome = result_.scans[graph_.keyframes[i].scan_index];
    if (i > 0 && !graph_.edges[i - 1].culled_covariance) {
      const std::optional<EdgeChosen> chosen = judge_edge(graph_, map_, i - 1, options_, outcome);
      if (chosen) events_.on_edge_chosen(*chosen);
    }
    outcome.component = component_of(i);
    outcome.starts_component = i == 0 || map_.component[i] != map_.component[i - 1];
    PlacedScan& placed = add(outcome, map_.map_from_keyframe[i]);
    if (!sweeps_.empty()) placed.robot_from_sweep = sweeps_[i];
  }

  void place_attached(const AttachedScan& scan) {
    ScanResult& outcome = result_.scans[scan.scan_index];
    outcome.match = judged({scan.pose}, 0, kFullMargin, options_);
    outcome.reference = graph_.keyframes[scan.keyframe].scan_index;
    outcome.is_keyframe = false;
    outcome.component = component_of(scan.keyframe);
    add(outcome, map_.map_from_keyframe[scan.keyframe] * scan.pose.ref_from_query);
  }

  /// Returns the number of a keyframe's component; components are numbered in the order of scans.
  int component_of(std::size_t keyframe) {
    const auto [found, is_new] =
        number_of_component_.try_emplace(map_.component[keyframe], static_cast<int>(result_.components.size()));
    if (is_new) result_.components.emplace_back();
    return found->second;
  }

  /// Smooths the trajectory, because scans that are attached to keyframes are placed one by one.
  void smooth(Component& component) const {
    std::vector<TrackedPose> poses;
    for (const PlacedScan& placed : component.scans) {
      const ScanResult& outcome = result_.scans[placed.scan_index];
      TrackedPose pose{placed.scan_index, outcome.session, placed.map_from_robot, {}};
      if (!outcome.is_keyframe) pose.covariance = covariance_in_map(outcome.match, placed.map_from_robot);
      poses.push_back(pose);
    }
    smooth_trajectory(poses);
    for (std::size_t i = 0; i < poses.size(); ++i) component.scans[i].map_from_robot = poses[i].map_from_robot;
  }

  PlacedScan& add(const ScanResult& outcome, const Pose2& map_from_robot) {
    PlacedScan placed;
    placed.scan_index = outcome.scan_index;
    placed.timestamp_s = outcome.timestamp_s;
    placed.map_from_robot = map_from_robot;
    placed.robot_from_sweep.resize(num_sweeps_[placed.scan_index]);
    std::vector<PlacedScan>& scans = result_.components[static_cast<std::size_t>(outcome.component)].scans;
    scans.push_back(std::move(placed));
    return scans.back();
  }

  const KeyframeGraph& graph_;
  const OptimizedMap& map_;
  const SweepCorrections& sweeps_;
  const std::vector<std::size_t>& num_sweeps_;
  const ConfidenceOptions& options_;
  MappingEvents& events_;
  MapResult& result_;
  std::map<std::size_t, int> number_of_component_;
};

}  // namespace

void build_trajectory(const SolvedGraph& solved, const std::vector<std::size_t>& num_sweeps,
                      const ConfidenceOptions& options, MappingEvents& events, MapResult& result) {
  TrajectoryBuilder(solved, num_sweeps, options, events, result).run();
}

}  // namespace shapemap
