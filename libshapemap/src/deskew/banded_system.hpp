// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace shapemap {

/// The system is symmetric and positive definite, and an unknown only meets those near it in the list.
class BandedSystem {
 public:
  /// An unknown meets others that are less than `bandwidth` away.
  BandedSystem(std::size_t size, std::size_t bandwidth);

  /// Adds `a` and `b` for the unknowns from `first` on.
  void add(std::size_t first, const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
  void add_to_diagonal(std::size_t row, double value) { rows_(static_cast<Eigen::Index>(row), 0) += value; }

  /// Solves by Cholesky's method in place, which uses the system up.
  Eigen::VectorXd solve();

 private:
  Eigen::Index size_;
  Eigen::Index width_;
  /// Row i holds the entries (i, i), (i, i + 1) ... (i, i + width - 1).
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows_;
  Eigen::VectorXd right_;
};

}  // namespace shapemap
