// SPDX-License-Identifier: GPL-3.0-or-later
#include "step_statistics.hpp"

#include <algorithm>
#include <utility>

namespace shapemap {
namespace {

constexpr double kLeastStep_m = 0.3;
constexpr double kLeastTurn_rad = 30 * kDegree;

double nineteen_of_twenty(std::vector<double> values, double least) {
  if (values.empty()) return least;
  std::sort(values.begin(), values.end());
  return std::max(least, values[values.size() * 95 / 100]);
}

}  // namespace

StepStatistics step_statistics(const std::vector<Pose2>& steps) {
  std::vector<double> steps_m;
  std::vector<double> turns_rad;
  for (const Pose2& a_from_b : steps) {
    steps_m.push_back(a_from_b.translation().norm());
    turns_rad.push_back(angle_between(a_from_b.theta_rad, 0.0));
  }
  return {nineteen_of_twenty(std::move(steps_m), kLeastStep_m),
          nineteen_of_twenty(std::move(turns_rad), kLeastTurn_rad)};
}

}  // namespace shapemap
