// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "shapemap/align/pose_hypothesis.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/graph/pose_graph.hpp"

namespace shapemap {

struct RefinementOptions {
  int rounds = 3;
  double within_m = 5.0;
  int neighbours = 8;
  double least_agree = 0.25;
  double most_off_m = 0.60;
  double most_off_rad = 6 * kDegree;
};

/// Aligns all scans that see the same from where the map has them, beside `chain`, and solves for all of it; several
/// times, since what is nearer to right aligns better.
std::vector<Pose2> refine_map(const std::vector<std::shared_ptr<const ScanView>>& views,
                              std::vector<Pose2> map_from_node, const std::vector<PoseConstraint>& chain,
                              const HypothesisSearchOptions& search, const RefinementOptions& options, int threads);

}  // namespace shapemap
