// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion/step_statistics.hpp"

#include <gmock/gmock.h>

#include "shapemap/graph/edge.hpp"

namespace shapemap {
namespace {

Edge edge_of(double step_m, double turn_rad, double probability) {
  Edge edge;
  edge.candidates.push_back({0, 1, {step_m, 0.0, turn_rad}, Eigen::Matrix3d::Identity(), 0.0});
  edge.probability = probability;
  return edge;
}

TEST(StepStatistics, NineteenOfTwentySureStepsAreShorter) {
  std::vector<Edge> edges;
  for (int k = 1; k <= 100; ++k) edges.push_back(edge_of(0.02 * k, (k % 2 == 0 ? 1 : -1) * k * kDegree, 0.99));
  edges.insert(edges.begin() + 40, edge_of(50.0, 3.0, 0.5));
  edges.insert(edges.begin() + 20, Edge{});
  const StepStatistics usual = step_statistics(sure_steps(edges));
  EXPECT_NEAR(usual.step_m, 1.92, 1e-9);
  EXPECT_NEAR(usual.turn_rad, 96 * kDegree, 1e-9);
}

TEST(StepStatistics, IsNotLessThanARobotThatStoodStillCouldDo) {
  for (const std::vector<Edge>& edges : {std::vector<Edge>{}, std::vector<Edge>(30, edge_of(0.01, 0.001, 0.99))}) {
    EXPECT_EQ(step_statistics(sure_steps(edges)).step_m, 0.3);
    EXPECT_EQ(step_statistics(sure_steps(edges)).turn_rad, 30 * kDegree);
  }
}

}  // namespace
}  // namespace shapemap
