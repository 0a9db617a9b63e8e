// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "shapemap/core/execution.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/graph/pose_graph.hpp"
#include "shapemap/matching/point_to_line.hpp"

/// Positions whose scan is made of several, each with a small error of its own.
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

/// Views of the sub-scans of each node, in the node's frame at their nominal headings.
using SweepViews = std::vector<std::vector<std::shared_ptr<const ScanView>>>;

struct SweepPoses {
  std::vector<Pose2> map_from_node;
  std::vector<std::vector<Pose2>> node_from_sweep;  ///< corrections: without an error, all are the identity
};

/// Where the nodes are, and what holds them there.
struct NodePoses {
  const std::vector<Pose2>& map_from_node;
  const std::vector<std::size_t>& component_of_node;
  const std::vector<PoseConstraint>& known;  ///< holds nodes where sweeps do not
};

/// Gives each sweep a pose of its own, tied to its nominal place in its node, and matches it to all sweeps of near
/// nodes of the same component that share what they see; several times. A node is where its sweeps say in the mean, as
/// their errors do not depend on each other. It stops between two rounds when the observer asks to.
SweepPoses refine_sweeps(const SweepViews& views, const NodePoses& nodes, const PointToLineOptions& line,
                         const SweepRefinementOptions& options, const Execution& execution);

}  // namespace shapemap
