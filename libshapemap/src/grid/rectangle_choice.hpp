// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace shapemap {

struct CellIndex {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

/// The rectangle has the cells from left to right and from bottom to top, the last ones included.
struct Rectangle {
  std::int64_t left = 0;
  std::int64_t right = 0;
  std::int64_t bottom = 0;
  std::int64_t top = 0;

  bool holds(const CellIndex& cell) const {
    return left <= cell.x && cell.x <= right && bottom <= cell.y && cell.y <= top;
  }
};

/// A known cell is one in which something was seen, with its worth as evidence.
struct KnownCell {
  CellIndex index;
  std::int64_t worth = 1;
};

/// Returns the rectangle around `scans` that is worth its size, as certain_box() says, or nothing where it is best to
/// hold all. `softening_cells` is added to width and height, so that a map without width (a straight way) does not
/// count as infinitely small. The order of the cells does not matter.
std::optional<Rectangle> best_rectangle(const std::vector<KnownCell>& cells, const Rectangle& scans,
                                        double softening_cells);

}  // namespace shapemap
