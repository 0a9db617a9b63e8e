// SPDX-License-Identifier: GPL-3.0-or-later
#include "banded_system.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap {

BandedSystem::BandedSystem(std::size_t size, std::size_t bandwidth)
    : size_(static_cast<Eigen::Index>(size)),
      width_(static_cast<Eigen::Index>(std::min(size, bandwidth))),
      rows_(decltype(rows_)::Zero(size_, width_)),
      right_(Eigen::VectorXd::Zero(size_)) {}

void BandedSystem::add(std::size_t first, const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const auto at = static_cast<Eigen::Index>(first);
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    rows_.row(at + i).head(a.cols() - i) += a.row(i).tail(a.cols() - i);
  }
  right_.segment(at, b.size()) += b;
}

Eigen::VectorXd BandedSystem::solve() {
  for (Eigen::Index i = 0; i < size_; ++i) {
    const Eigen::Index num = std::min(width_, size_ - i);
    const double root = std::sqrt(rows_(i, 0));
    rows_.row(i).head(num) /= root;
    for (Eigen::Index k = 1; k < num; ++k) {
      const double factor = rows_(i, k);
      if (factor != 0.0) rows_.row(i + k).head(num - k) -= factor * rows_.row(i).segment(k, num - k);
    }
  }
  Eigen::VectorXd x = right_;
  for (Eigen::Index i = 0; i < size_; ++i) {
    const Eigen::Index num = std::min(width_, size_ - i);
    x[i] /= rows_(i, 0);
    for (Eigen::Index k = 1; k < num; ++k) x[i + k] -= rows_(i, k) * x[i];
  }
  for (Eigen::Index i = size_ - 1; i >= 0; --i) {
    const Eigen::Index num = std::min(width_, size_ - i);
    for (Eigen::Index k = 1; k < num; ++k) x[i] -= rows_(i, k) * x[i + k];
    x[i] /= rows_(i, 0);
  }
  return x;
}

}  // namespace shapemap
