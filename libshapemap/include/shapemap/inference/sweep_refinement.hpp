// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "shapemap/core/execution.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/graph/pose_graph.hpp"
#include "shapemap/matching/point_to_line.hpp"

/// Sweep refinement corrects the sweeps of scans that consist of several, each with a small error of its own.
namespace shapemap {

struct SweepRefinementOptions {
  int rounds = 10;
  double sigma_m = 0.015;
  double sigma_rad = 0.7 * kDegree;
  double within_m = 6.0;
  double gate_m = 0.08;
  int least_partners = 3;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"sweep-rounds", "rounds of refining the sub-scans of all positions; 0: each position is rigid", 0, 100}
              .formerly("sub-scan-rounds"),
          self.rounds);
    visit(Field{"sweep-sigma-m", "how far a sub-scan is from its nominal place, standard deviation [m]", 1e-4, 1}
              .formerly("sub-scan-sigma-m"),
          self.sigma_m);
    visit(Field{"sweep-sigma-deg", "and how much it is turned [deg]", 0.01, 45, kDegree}.formerly("sub-scan-sigma-deg"),
          self.sigma_rad);
    visit(Field{"sweep-within-m", "sub-scans of positions nearer than this are aligned to each other [m]", 0.1, 100}
              .formerly("sub-scan-within-m"),
          self.within_m);
    visit(
        Field{"sweep-gate-m", "points of two sub-scans farther apart than this are no partners [m]", 0.01, 1}.formerly(
            "sub-scan-gate-m"),
        self.gate_m);
    visit(Field{"sweep-least-partners", "two sub-scans with fewer partners are not aligned", 3, 10000}.formerly(
              "sub-scan-least-partners"),
          self.least_partners);
  }
};

/// The views of the sweeps of each node, in the frame of the node at their nominal headings.
using SweepViews = std::vector<std::vector<std::shared_ptr<const ScanView>>>;

struct SweepPoses {
  std::vector<Pose2> map_from_node;
  std::vector<std::vector<Pose2>> node_from_sweep;  ///< corrections; the identity where a sweep has no error
};

/// The poses of the nodes, and the constraints on them.
struct NodePoses {
  const std::vector<Pose2>& map_from_node;
  const std::vector<std::size_t>& component_of_node;
  const std::vector<PoseConstraint>& known;  ///< constrains nodes where sweeps do not
};

/// Gives each sweep a pose of its own, tied to its nominal place in its node, and matches it to all sweeps of near
/// nodes of the same component. This is repeated. The pose of a node is the mean of what its sweeps say, because their
/// errors are independent. It ends after the current round when the observer asks to stop.
SweepPoses refine_sweeps(const SweepViews& views, const NodePoses& nodes, const PointToLineOptions& line,
                         const SweepRefinementOptions& options, const Execution& execution);

}  // namespace shapemap
