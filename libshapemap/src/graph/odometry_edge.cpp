// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/odometry_edge.hpp"

namespace shapemap {

std::vector<Pose2> sure_steps(const std::vector<EdgeChoices>& edges) {
  constexpr double kSure = 0.9;
  std::vector<Pose2> steps;
  for (const EdgeChoices& edge : edges) {
    if (edge.exists() && edge.probability > kSure) steps.push_back(edge.candidates.front().a_from_b);
  }
  return steps;
}

}  // namespace shapemap
