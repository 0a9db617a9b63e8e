// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "loops/conflicting_loops.hpp"
#include "motion/step_statistics.hpp"
#include "shapemap/graph/pose_graph.hpp"
#include "shapemap/inference/map_score.hpp"
#include "shapemap/inference/map_search.hpp"

namespace shapemap {

/// What has been decided about loops and links, and the map that follows.
struct MapHypothesis {
  std::vector<int> edge_choice;
  std::vector<char> accepted;      ///< per cluster
  std::vector<Pose2> refused_off;  ///< per cluster: how far off the map was when it was last refused
  std::vector<Pose2> map_from_node;
  double chi_square = 0.0;
  double value = 0.0;
};

/// Maps that follow from choices, and what they are worth.
class MapObjective {
 public:
  MapObjective(const GraphEvidence& evidence, const VisibilityOptions& visibility, const MapSearchOptions& options,
               int threads);

  /// The chain by itself, without loops. Pieces that nothing joins lie far apart.
  MapHypothesis chain_alone();
  /// The alternatives that a map takes, and the loops that it closes.
  MapHypothesis of_map(std::vector<Pose2> map_from_node);

  /// Poses from the choices made, starting from those there are.
  void solve(MapHypothesis& choice) const;
  /// Sets `value`, which costs much more than to solve.
  void rate(MapHypothesis& choice);

  /// How far the map is off what the best member of a cluster says.
  Pose2 off(const MapHypothesis& choice, std::size_t cluster) const;
  std::vector<PoseConstraint> constraints(const MapHypothesis& choice) const;
  /// For each node, a number that it shares with those that loops hold to it.
  std::vector<std::size_t> rings(const MapHypothesis& choice) const;
  const PoseConstraint& best_member(std::size_t cluster) const { return loop_constraints_[cluster].front(); }
  /// What closing a loop is worth by itself.
  double worth(std::size_t cluster) const;
  /// What it is worth in a map: less where the same nodes look like another place that they are not at in this map.
  double worth_in(const MapHypothesis& choice, std::size_t cluster) const;

  MapScore& score() { return score_; }
  std::size_t num_nodes() const { return num_nodes_; }

 private:
  /// All links cut, no loop closed.
  MapHypothesis undecided(std::vector<Pose2> map_from_node) const;
  double cost_of_edges(const MapHypothesis& choice) const;
  /// Of all that are closed. Those between the same two stretches of the way are worth little more than the best of
  /// them: when the one is wrong since the stretches look alike, so are the others.
  double worth_of_loops(const MapHypothesis& choice) const;

  const std::vector<Edge>& edges_;
  const std::vector<LoopCluster>& clusters_;
  const MapSearchOptions& options_;
  MapScore score_;
  std::size_t num_nodes_;
  StepStatistics usual_;
  std::vector<std::vector<PoseConstraint>> loop_constraints_;
  std::vector<std::vector<ConflictingLoop>> conflicts_;  ///< of each cluster
};

}  // namespace shapemap
