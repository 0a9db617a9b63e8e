// SPDX-License-Identifier: GPL-3.0-or-later
#include "hill_climbing.hpp"

#include <array>

namespace shapemap::baselines {
namespace {

/// No score has so long a slope; one that is not finite or not a function of the pose ends here.
constexpr int kMaxMoves = 1000;

}  // namespace

Pose2 climb(const Pose2& start, const std::function<double(const Pose2&)>& score, ClimbSteps steps) {
  Pose2 best = start;
  double best_score = score(start);
  for (int halved = 0; halved <= steps.halvings; ++halved) {
    const std::array<Pose2, 6> moves{{{steps.step_m, 0.0, 0.0},
                                      {-steps.step_m, 0.0, 0.0},
                                      {0.0, steps.step_m, 0.0},
                                      {0.0, -steps.step_m, 0.0},
                                      {0.0, 0.0, steps.step_rad},
                                      {0.0, 0.0, -steps.step_rad}}};
    bool improved = true;
    for (int count = 0; improved && count < kMaxMoves; ++count) {
      improved = false;
      const Pose2 here = best;
      for (const Pose2& move : moves) {
        const Pose2 there = here * move;
        const double there_score = score(there);
        if (!(there_score > best_score)) continue;
        best = there;
        best_score = there_score;
        improved = true;
      }
    }
    steps.step_m /= 2;
    steps.step_rad /= 2;
  }
  return best;
}

}  // namespace shapemap::baselines
