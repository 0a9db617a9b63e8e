// SPDX-License-Identifier: GPL-3.0-or-later
#include "deskew/banded_system.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace shapemap {
namespace {

TEST(BandedSystem, IsSolvedAsTheSameSystemWithoutBands) {
  constexpr Eigen::Index kSize = 23;
  constexpr Eigen::Index kBlock = 5;
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  BandedSystem banded(kSize, kBlock);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kSize, kSize);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kSize);
  for (Eigen::Index first = 0; first + kBlock <= kSize; ++first) {
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(kBlock, kBlock, [&]() { return unit(rng); });
    const Eigen::MatrixXd a = root * root.transpose();
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(kBlock, [&]() { return unit(rng); });
    banded.add(static_cast<std::size_t>(first), a, b);
    dense.block(first, first, kBlock, kBlock) += a;
    right.segment(first, kBlock) += b;
  }
  for (Eigen::Index row = 0; row < kSize; ++row) {
    banded.add_to_diagonal(static_cast<std::size_t>(row), 0.1);
    dense(row, row) += 0.1;
  }
  const Eigen::VectorXd expected = dense.ldlt().solve(right);
  EXPECT_LT((banded.solve() - expected).norm(), 1e-9 * expected.norm());
}

}  // namespace
}  // namespace shapemap
