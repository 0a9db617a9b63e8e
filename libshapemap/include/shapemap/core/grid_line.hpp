// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace shapemap {

/// Follows Bresenham's line (Bresenham 1965): calls `visit(cell)` for each cell from `from` up to the one before `to`,
/// as long as `visit` returns true.
template <class Visit>
void while_cell_before(Eigen::Vector2i from, const Eigen::Vector2i& to, Visit&& visit) {
  const Eigen::Vector2i step(from.x() < to.x() ? 1 : -1, from.y() < to.y() ? 1 : -1);
  const Eigen::Vector2i length = (to - from).cwiseAbs();
  int balance = length.x() - length.y();
  while (from != to) {
    if (!visit(static_cast<const Eigen::Vector2i&>(from))) return;
    const int twice = 2 * balance;
    if (twice > -length.y()) {
      balance -= length.y();
      from.x() += step.x();
    }
    if (twice < length.x()) {
      balance += length.x();
      from.y() += step.y();
    }
  }
}

/// Calls `visit(cell)` for all of these cells, whatever it returns.
template <class Visit>
void for_each_cell_before(const Eigen::Vector2i& from, const Eigen::Vector2i& to, Visit&& visit) {
  while_cell_before(from, to, [&](const Eigen::Vector2i& cell) {
    visit(cell);
    return true;
  });
}

}  // namespace shapemap
