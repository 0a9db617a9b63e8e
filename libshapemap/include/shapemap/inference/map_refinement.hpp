// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "shapemap/core/execution.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/graph/pose_graph.hpp"
#include "shapemap/matching/match_search.hpp"

namespace shapemap {

struct RefinementOptions {
  int rounds = 3;
  double within_m = 5.0;
  int neighbours = 8;
  double least_agree = 0.25;
  double most_off_m = 0.60;
  double most_off_rad = 6 * kDegree;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"map-rounds", "rounds of aligning all neighbours and solving for all poses", 0, 100}, self.rounds);
    visit(Field{"map-within-m", "keyframes nearer than this are neighbours [m]", 0.1, 100}, self.within_m);
    visit(Field{"map-neighbours", "neighbours that each keyframe is aligned to, at most", 0, 1000}, self.neighbours);
    visit(Field{"map-least-agree", "share of the points of neighbours that must agree", 0, 1}, self.least_agree);
    visit(Field{"map-most-off-m", "an alignment farther than this from the map does not count [m]", 0.01, 10},
          self.most_off_m);
    visit(Field{"map-most-off-deg", "nor one that is turned more [deg]", 0.1, 180, kDegree}, self.most_off_rad);
  }
};

struct RefinedMap {
  std::vector<Pose2> map_from_node;
  std::vector<PoseConstraint> neighbours;  ///< the matches of the last solution, without the odometry
};

struct MapRefinement {
  const MatchSearchOptions& search;
  const RefinementOptions& refinement;
};

/// Matches all scans that see the same, starting at the poses of the map, and solves the pose graph of these matches
/// and the constraints `odometry` (after Lu and Milios 1997). This is repeated, because better poses give better
/// matches. It ends after the current round when the observer asks to stop.
RefinedMap refine_map(const std::vector<std::shared_ptr<const ScanView>>& views, std::vector<Pose2> map_from_node,
                      const std::vector<PoseConstraint>& odometry, const MapRefinement& options,
                      const Execution& execution);

}  // namespace shapemap
