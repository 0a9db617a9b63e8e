// SPDX-License-Identifier: GPL-3.0-or-later
#include "deskew/sweep_trajectory.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace shapemap {
namespace {

SweepTrajectory random_trajectory(unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  SweepTrajectory trajectory(2.0, 3.1, 0.1);
  for (Eigen::Vector3d& control : trajectory.controls()) control = {unit(rng), unit(rng), 4.0 * unit(rng)};
  return trajectory;
}

TEST(SweepTrajectory, WeightsAreThoseOfAMean) {
  const SweepTrajectory trajectory(0.0, 1.0, 0.1);
  for (double time_s = -0.05; time_s < 1.1; time_s += 0.013) {
    const auto weights = trajectory.support(time_s).weights;
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-12);
  }
}

TEST(SweepTrajectory, GoesAlongALineEvenly) {
  SweepTrajectory trajectory(5.0, 6.0, 0.13);
  for (std::size_t k = 0; k < trajectory.controls().size(); ++k) {
    trajectory.controls()[k] = Eigen::Vector3d(1.0, -2.0, 7.0) * trajectory.time_of(k);
  }
  for (double time_s = 5.0; time_s <= 6.0; time_s += 0.041) {
    EXPECT_LT((trajectory.at(time_s) - Eigen::Vector3d(1.0, -2.0, 7.0) * time_s).norm(), 1e-9);
  }
}

TEST(SweepTrajectory, IsTheSameMotionWithMoreKnots) {
  const SweepTrajectory trajectory = random_trajectory(3);
  const SweepTrajectory fine = trajectory.refined();
  EXPECT_DOUBLE_EQ(fine.knot_s(), 0.5 * trajectory.knot_s());
  for (double time_s = 2.0; time_s <= 3.1; time_s += 0.0071) {
    EXPECT_LT((trajectory.at(time_s) - fine.at(time_s)).norm(), 1e-9) << time_s;
  }
}

TEST(SweepTrajectory, IsSmoothAtItsKnots) {
  const SweepTrajectory trajectory = random_trajectory(5);
  for (double knot_s = 2.1; knot_s < 3.05; knot_s += 0.1) {
    EXPECT_LT((trajectory.at(knot_s - 1e-7) - trajectory.at(knot_s + 1e-7)).norm(), 1e-4) << knot_s;
  }
}

}  // namespace
}  // namespace shapemap
