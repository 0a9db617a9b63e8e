// SPDX-License-Identifier: GPL-3.0-or-later
#include "odometry_trail.hpp"

#include "graph/keyframe_graph.hpp"
#include "shapemap/matching/match_probability.hpp"
#include "shapemap/matching/scan_matcher.hpp"

namespace shapemap {

ScanUpdate OdometryTrail::add(const TrackedScan& scan, const Map* map) {
  ScanUpdate update;
  update.scan = scan.scan_index;
  update.version = map ? map->version : 0;
  if (scan.attached || scan.keyframe) match(scan, update);
  Step step;
  step.has_pose = update.role != ScanRole::kNoShape;
  if (update.reference != kNoReference) {
    step.stretch = steps_[update.reference].stretch;
    step.stretch_from_robot = steps_[update.reference].stretch_from_robot * update.reference_from_robot;
  } else if (step.has_pose) {
    step.stretch = num_stretches_++;
  }
  steps_.push_back(step);
  if (scan.keyframe) last_keyframe_ = scan.scan_index;
  update.pose = in_map(step, map);
  return update;
}

/// Fills in the role of a scan with shape, and its match to the last keyframe where there is one.
void OdometryTrail::match(const TrackedScan& scan, ScanUpdate& update) {
  update.role = scan.attached ? ScanRole::kAttached : ScanRole::kKeyframe;
  const MatchCandidate* best = scan.attached ? &*scan.attached : nullptr;
  double margin = kFullMargin;
  double insufficient_view = 0.0;
  if (scan.keyframe) {
    const OdometryEdge& edge = scan.keyframe->edge;
    if (edge.candidates.empty()) return;
    best = &edge.candidates.front();
    margin = lead_of_first(edge.candidates);
    insufficient_view = edge.insufficient_view;
  }
  const double by_two = match_probability(*best, margin);
  update.reference = last_keyframe_;
  update.reference_from_robot = best->ref_from_query;
  update.covariance = pose_covariance(best->fit);
  update.probability = scan.attached ? by_two : odometry_probability(by_two, insufficient_view);
}

/// Composes the pose of the last keyframe of the map with the matches since, where these join the scan to it.
ScanPose OdometryTrail::in_map(const Step& step, const Map* map) const {
  if (!step.has_pose) return {};
  if (!map || map->keyframes.empty()) {
    return step.stretch == 0 ? ScanPose{0, step.stretch_from_robot} : ScanPose{};
  }
  const std::size_t anchor = map->keyframes.back();
  if (steps_[anchor].stretch != step.stretch) return {};
  const ScanPose& known = map->scans[anchor];
  return {known.component, known.map_from_robot * inverse(steps_[anchor].stretch_from_robot) * step.stretch_from_robot};
}

}  // namespace shapemap
