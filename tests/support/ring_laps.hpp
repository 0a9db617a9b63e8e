// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "inference/optimized_map.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/scan/scan.hpp"
#include "support/ring_walk.hpp"

/// A robot goes round and round a ring; this header has its log, and keyframe graphs of it.
namespace shapemap::test {

inline MappingOptions quick_mapping() {
  MappingOptions options;
  options.robust.matcher.search.candidates.rotation_peaks = 4;
  options.robust.matcher.search.candidates.refined = 6;
  options.robust.matcher.search.candidates.kept = 3;
  options.robust.matcher.search.voting.peaks = 6;
  options.robust.loop_detection.likely_places = 3;
  options.robust.keyframes.settle_at = 0;
  options.run.threads = 1;
  return options;
}

struct Laps {
  explicit Laps(std::size_t count) : Laps(ring_walk(count, 4)) {}
  explicit Laps(std::vector<Pose2> poses) : truth(std::move(poses)) {
    std::mt19937 rng(7);
    for (const Pose2& pose : truth) log.scans.push_back(scan_of(ring_world(1), pose, full_circle(), rng));
  }
  std::vector<Pose2> truth;
  Log log;
};

inline const Laps& two_laps() {
  static const Laps laps(2 * kRingLap);
  return laps;
}

/// The graph has its keyframes at `poses` and sure odometry edges; the map follows from it.
struct KnownGraph {
  KnownGraph(const Laps& laps, const std::vector<Pose2>& poses) {
    const MappingOptions options = quick_mapping();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      auto view = std::make_shared<ScanView>(
          view_of(laps.log.scans[i], options.returns, options.polylines, options.shape, options.robust.matcher.view));
      graph.keyframes.push_back({i, 0, std::move(view), {}, {}});
      if (i == 0) continue;
      const Pose2 step = inverse(poses[i - 1]) * poses[i];
      OdometryEdge edge;
      edge.candidates = {
          candidate_at(*graph.keyframes[i - 1].view, *graph.keyframes[i].view, step, options.robust.matcher.search)};
      graph.edges.push_back(std::move(edge));
      map.constraints.push_back(edge_constraint(graph, i - 1, 0));
    }
    for (std::size_t i = 0; i + 2 < poses.size(); ++i) {
      graph.edges[i].transition_scores = no_transition_scores(graph.edges[i], graph.edges[i + 1]);
    }
    choose_candidates(graph);
    map.map_from_keyframe = poses;
    map.edge_choice.assign(graph.edges.size(), 0);
    map.loop_constrained.assign(graph.edges.size(), true);
    map.component.assign(poses.size(), 0);
  }
  explicit KnownGraph(const Laps& laps) : KnownGraph(laps, laps.truth) {}

  KeyframeGraph graph;
  OptimizedMap map;
};

}  // namespace shapemap::test
