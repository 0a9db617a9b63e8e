// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/placed_scan.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

/// Most walls of a building have one direction, up to quarter turns.
namespace shapemap {

struct WallOptions {
  bool align_walls = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"align-walls", "turn the map so that most walls are along the borders of the picture"},
          self.align_walls);
  }
};

struct WallDirection {
  double angle_rad = 0.0;     ///< in (-45, 45] degrees from the x axis of the map; meaningless where nothing was seen
  double share = 0.0;         ///< share of all wall length that has this direction within 5 degrees
  double second_share = 0.0;  ///< the same share of the best direction at least 10 degrees off

  /// Says whether this is the direction of the building. A round room, or a cave, has 0.11 of its walls in any 10 of 90
  /// degrees; an octagon has two directions that are as good, a triangle three.
  bool is_dominant() const { return share >= 0.3 && share >= 1.5 * second_share; }
  /// Returns the angle by which the map is turned.
  double turn_rad() const { return is_dominant() ? -angle_rad : 0.0; }
};

/// Finds the direction from straight stretches that are fitted to the returns of one scan of each visit. A stretch of
/// length l weighs l^2 / (l + m), where half of all wall is in stretches shorter than m: clutter counts less than its
/// length, so that a long wall outweighs what stands before it. The total weight of a visit is limited likewise, so
/// that a hall that was seen once through a door does not outweigh the rooms. The direction is the mode of these modulo
/// 90 degrees, refined to the mean of what is within 5 degrees of it.
WallDirection wall_direction(const std::vector<Scan>& scans, const std::vector<PlacedScan>& placed,
                             const ReturnOptions& returns);

/// Turns each component about its origin by the least turn that makes its walls straight. Motions between its scans
/// stay what they are. Returns one direction for each component.
std::vector<WallDirection> align_walls(const std::vector<Scan>& scans, const ReturnOptions& returns,
                                       std::vector<Component>& components);

}  // namespace shapemap
