// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shapemap/core/options.hpp"
#include "shapemap/scan/placed_scan.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// This choice decides what scans draw that contradict the rest of the map.
enum class Contradicting {
  kFillGaps,  ///< only where no other scan has seen anything, up to the first surface of theirs
  kAsOthers,
};

template <>
struct EnumNames<Contradicting> {
  static constexpr std::array<std::string_view, 2> names{"fill-gaps", "as-others"};
};

struct OccupancyGridOptions {
  double resolution_m = 0.05;
  Contradicting contradicting = Contradicting::kFillGaps;
  bool draw_all = false;
  double clear_no_return_m = 0.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"resolution-m", "side of a map cell [m]", 0.001, 10}, self.resolution_m);
    visit(Field{"contradicting-scans", "what scans that contradict the rest of the map draw into it"},
          self.contradicting);
    visit(Field{"draw-all", "make the picture large enough for all returns, also false and far ones"}, self.draw_all);
    visit(Field{"clear-no-return-m",
                "beams without a return are drawn free for so long, or up to the laser's range [m]; 0: not at all", 0,
                1000},
          self.clear_no_return_m);
  }
};

/// The grid holds occupancy probabilities. Row 0 is the top of the picture (largest y), as in ROS map_server.
struct OccupancyGrid {
  double resolution_m = 0.0;
  Point2 origin_m{0.0, 0.0};  ///< lower left corner of the lower left cell, in the map frame
  int width_cells = 0;
  int height_cells = 0;
  std::vector<std::uint8_t> grey;  ///< row-major; 0 occupied, 255 free, 127 or 128 unknown
  std::size_t num_returns = 0;     ///< returns of all scans that were drawn
  std::size_t num_outside = 0;     ///< number of these that lie outside of the picture

  /// Returns the column and row of a point, also outside of the grid.
  Eigen::Vector2i pixel_at(const Point2& p_in_map_m) const;
};

/// Builds the ray-traced occupancy grid of placed scans with MRPT's grid map. Scans that contradict the rest are drawn
/// last. A few far returns that would make the grid many times larger lie outside, and their beams are drawn up to its
/// rim, unless `options.draw_all`. Throws OutputError when there are no scans or the map would have more than 400
/// million cells, and ConfigError when an option is out of its range.
OccupancyGrid build_occupancy_grid(const std::vector<Scan>& scans, const std::vector<PlacedScan>& placed,
                                   const ReturnOptions& returns, const OccupancyGridOptions& options);

}  // namespace shapemap
