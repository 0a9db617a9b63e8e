// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "shapemap/core/execution.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/graph/edge.hpp"
#include "shapemap/loops/loop_clusters.hpp"
#include "shapemap/loops/loop_detection.hpp"
#include "shapemap/matching/visibility.hpp"

/// The map search decides which loops are closed, and which candidate each doubtful odometry edge takes.
namespace shapemap {

struct MapSearchOptions {
  int assemblies = 12;
  double doubt_below = 0.97;
  int repairs = 12;
  double trust_cap = 20.0;
  double least_gain = 3.0;
  double step_penalty = 4.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"submap-merges", "maps of which the best is pursued, put together from sure pieces", 1, 1000}.formerly(
              "loop-assemblies"),
          self.assemblies);
    visit(Field{"loop-doubt-below", "a less probable alignment of the chain may be replaced", 0, 1}, self.doubt_below);
    visit(Field{"loop-repairs", "contradictions that are looked into, in each round", 0, 1000}, self.repairs);
    visit(Field{"loop-trust-cap",
                "what all loops between two stretches of the way can weigh at most, as logarithm of odds", 0, 1000},
          self.trust_cap);
    visit(Field{"loop-least-gain", "what a change must gain, as logarithm of odds", 0, 1000}, self.least_gain);
    visit(Field{"step-penalty", "against each usual step or turn that a doubtful one is longer", 0, 100},
          self.step_penalty);
  }
};

/// The map with the largest value that was found.
struct MapSolution {
  std::vector<Pose2> map_from_node;
  std::vector<int> edge_choice;        ///< of each edge: its candidate, or kCut where loops tell better
  std::vector<std::size_t> accepted;   ///< indices of the closed clusters, in order
  std::vector<std::size_t> component;  ///< of each node: the first node of its component
  double value = 0.0;                  ///< log odds of the map, up to a constant
};
inline constexpr int kCut = -1;

/// The evidence about a graph before its map is searched.
struct GraphEvidence {
  const NodeViews& views;          ///< of each node
  const std::vector<Edge>& edges;  ///< edge i joins node i to node i + 1
  const std::vector<EdgeCandidate>& loops;
  const std::vector<LoopCluster>& clusters;  ///< loops that agree, strongest cluster first
};

/// Searches for the map with the largest value. The value of a map is the logarithm of its odds. It adds up the worth
/// of the closed loops and how well the scans fit each other (MapScore), less the cost of unlikely candidates and half
/// of the squared errors of the pose graph. Loops that raise the value are closed, strongest first. Then the search
/// looks into contradictions: a strong loop that does not fit, or a doubtful edge, may show that another edge or loop
/// is wrong. When the observer asks to stop, the best map so far is returned.
MapSolution search_map(const GraphEvidence& evidence, const VisibilityOptions& visibility,
                       const MapSearchOptions& options, const Execution& execution);

}  // namespace shapemap
