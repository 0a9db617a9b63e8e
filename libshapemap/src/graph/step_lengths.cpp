// SPDX-License-Identifier: GPL-3.0-or-later
#include "step_lengths.hpp"

#include <algorithm>

namespace shapemap {
namespace {

constexpr double kSure = 0.9;
constexpr double kLeastStep_m = 0.3;

}  // namespace

double usual_step_m(const std::vector<ChainLink>& links) {
  std::vector<double> steps_m;
  for (const ChainLink& link : links) {
    if (link.exists() && link.probability > kSure) {
      steps_m.push_back(link.alternatives.front().a_from_b.translation().norm());
    }
  }
  if (steps_m.empty()) return kLeastStep_m;
  std::sort(steps_m.begin(), steps_m.end());
  return std::max(kLeastStep_m, steps_m[steps_m.size() * 95 / 100]);
}

}  // namespace shapemap
