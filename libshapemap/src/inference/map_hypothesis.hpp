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

/// The choices that are made about loops and edges, and the map that follows from them.
struct MapHypothesis {
  std::vector<int> edge_choice;
  std::vector<char> accepted;      ///< of each cluster: whether it is closed
  std::vector<Pose2> refused_off;  ///< of each cluster: error of the map when it was last refused
  std::vector<Pose2> map_from_node;
  double chi_square = 0.0;
  double value = 0.0;
};

/// The objective solves for the map that follows from choices, and rates it.
class MapObjective {
 public:
  MapObjective(const GraphEvidence& evidence, const VisibilityOptions& visibility, const MapSearchOptions& options,
               int threads);

  /// Returns the map of the odometry edges, without loops. Components lie far apart.
  MapHypothesis chain_alone();
  /// Returns the hypothesis of the candidates that a map agrees with, and of the loops that it closes.
  MapHypothesis of_map(std::vector<Pose2> map_from_node);

  /// Solves for the poses that follow from the choices, starting from the present poses.
  void solve(MapHypothesis& choice) const;
  /// Computes `value`, which takes much longer than to solve for the poses.
  void rate(MapHypothesis& choice);

  /// Returns the difference between the map and the best member of a cluster.
  Pose2 off(const MapHypothesis& choice, std::size_t cluster) const;
  std::vector<PoseConstraint> constraints(const MapHypothesis& choice) const;
  /// Returns, for each node, a number that it shares with the nodes that loops hold to it.
  std::vector<std::size_t> rings(const MapHypothesis& choice) const;
  const PoseConstraint& best_member(std::size_t cluster) const { return loop_constraints_[cluster].front(); }
  /// Returns what closing a loop is worth by itself.
  double worth(std::size_t cluster) const;
  /// Returns what closing a loop is worth in a map. It is less where the same nodes also look like a place at which
  /// this map does not have them.
  double worth_in(const MapHypothesis& choice, std::size_t cluster) const;

  MapScore& score() { return score_; }
  std::size_t num_nodes() const { return num_nodes_; }

 private:
  /// Returns a hypothesis in which all edges are cut and no loop is closed.
  MapHypothesis undecided(std::vector<Pose2> map_from_node) const;
  double cost_of_edges(const MapHypothesis& choice) const;
  /// Returns the worth of all closed loops. Several between the same two stretches of the trajectory are worth little
  /// more than the best of them: if one is wrong because the stretches look alike, so are the others.
  double worth_of_loops(const MapHypothesis& choice) const;

  const std::vector<Edge>& edges_;
  const std::vector<LoopCluster>& clusters_;
  const MapSearchOptions& options_;
  MapScore score_;
  std::size_t num_nodes_;
  StepStatistics usual_;
  std::vector<std::vector<PoseConstraint>> loop_constraints_;
  std::vector<std::vector<ConflictingLoop>> conflicts_;  ///< of each cluster: loops that contradict it
};

}  // namespace shapemap
