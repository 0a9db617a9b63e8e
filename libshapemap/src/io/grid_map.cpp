// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/grid_map.hpp"

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "shapemap/core/errors.hpp"
#include "shapemap/core/grid_line.hpp"
#include "shapemap/map/placed_rays.hpp"

namespace shapemap {
namespace {

using MrptGrid = mrpt::maps::COccupancyGridMap2D;

constexpr int kMarginCells = 4;           // so that walls at the rim stay visible
constexpr double kMaxCells = 400e6;       // one byte each here, up to four in a coloured picture
constexpr double kMaxCellsPerSide = 1e6;  // readers of pictures, OpenCV's too, refuse wider ones

struct AllRays {
  std::vector<Rays> plain;
  std::vector<Rays> contradicting;
};

AllRays rays_in_map(const Log& log, const std::vector<PlacedPosition>& placed, const ReturnOptions& returns,
                    Contradicting contradicting) {
  AllRays all;
  for (const PlacedPosition& place : placed) {
    const bool apart = contradicting == Contradicting::kFillGaps && place.agreement.contradicts_map;
    for (Rays& rays : rays_of(log, place, returns)) (apart ? all.contradicting : all.plain).push_back(std::move(rays));
  }
  return all;
}

/// Extent in whole cells; cell (0, 0) has its lower left corner at the origin of the map frame.
struct Extent {
  double left = std::numeric_limits<double>::infinity();
  double bottom = std::numeric_limits<double>::infinity();
  double right = -std::numeric_limits<double>::infinity();
  double top = -std::numeric_limits<double>::infinity();

  void include(const Point2& p_m, double resolution_m) {
    left = std::min(left, std::floor(p_m.x() / resolution_m) - kMarginCells);
    bottom = std::min(bottom, std::floor(p_m.y() / resolution_m) - kMarginCells);
    right = std::max(right, std::floor(p_m.x() / resolution_m) + kMarginCells);
    top = std::max(top, std::floor(p_m.y() / resolution_m) + kMarginCells);
  }
  double width() const { return right - left + 1.0; }
  double height() const { return top - bottom + 1.0; }
};

Extent extent_of(const AllRays& all, const std::vector<PlacedPosition>& placed, double resolution_m) {
  Extent extent;
  for (const PlacedPosition& place : placed) extent.include(place.map_from_robot.translation(), resolution_m);
  for (const std::vector<Rays>* some : {&all.plain, &all.contradicting}) {
    for (const Rays& rays : *some) {
      extent.include(rays.from_m, resolution_m);
      for (const Point2& hit_m : rays.hits_m) extent.include(hit_m, resolution_m);
    }
  }
  return extent;
}

void check_size(const Extent& extent, double resolution_m) {
  const bool fits = extent.width() <= kMaxCellsPerSide && extent.height() <= kMaxCellsPerSide &&
                    extent.width() * extent.height() <= kMaxCells;
  if (fits) return;  // written so that NaN fails
  std::ostringstream why;
  why << "the map would be " << extent.width() * resolution_m << " x " << extent.height() * resolution_m
      << " m, more than " << kMaxCells << " cells of " << resolution_m
      << " m; raise --resolution-m, or lower --max-range";
  throw OutputError(why.str());
}

/// Evidence for a cell, in MRPT's log-odds of being free. The certainties are those of MRPT's own insertion.
struct Evidence {
  MrptGrid::cellType free = std::max<MrptGrid::cellType>(1, MrptGrid::p2l(0.65F));
  MrptGrid::cellType occupied = static_cast<MrptGrid::cellType>(3 * free);
  MrptGrid::cellType free_limit = static_cast<MrptGrid::cellType>(MrptGrid::OCCGRID_CELLTYPE_MAX - free);
  MrptGrid::cellType occupied_limit = static_cast<MrptGrid::cellType>(MrptGrid::OCCGRID_CELLTYPE_MIN + occupied);
};

/// One beam by Bresenham's line: free up to the hit, occupied there. MRPT's own insertion of a scan is not used:
/// it spaces n beams by aperture / n rather than aperture / (n - 1), does not know tilted lasers, and lets long rays
/// drift off by a cell.
void insert_ray(MrptGrid& grid, const Eigen::Vector2i& from, const Eigen::Vector2i& hit, const Evidence& evidence) {
  for_each_cell_before(from, hit, [&](const Eigen::Vector2i& cell) {
    MrptGrid::updateCell_fast_free(grid.getRow(cell.y()) + cell.x(), evidence.free, evidence.free_limit);
  });
  MrptGrid::updateCell_fast_occupied(grid.getRow(hit.y()) + hit.x(), evidence.occupied, evidence.occupied_limit);
}

/// What the grid says before scans that contradict it are drawn.
class GridBefore {
 public:
  explicit GridBefore(const MrptGrid& grid) : width_(grid.getSizeX()) {
    for (std::size_t y = 0; y < grid.getSizeY(); ++y) {
      const MrptGrid::cellType* row = grid.getRow(static_cast<int>(y));
      cells_.insert(cells_.end(), row, row + width_);
    }
  }
  /// Nobody looked, or as many saw it free as occupied.
  bool is_unknown(const Eigen::Vector2i& cell) const { return at(cell) == 0; }
  bool is_occupied(const Eigen::Vector2i& cell) const { return at(cell) < 0; }

 private:
  MrptGrid::cellType at(const Eigen::Vector2i& cell) const {
    return cells_[static_cast<std::size_t>(cell.y()) * width_ + static_cast<std::size_t>(cell.x())];
  }
  std::size_t width_;
  std::vector<MrptGrid::cellType> cells_;
};

/// Draws a beam only where nothing is known, and up to the first surface that is.
void fill_gaps(MrptGrid& grid, const GridBefore& before, const Eigen::Vector2i& from, const Eigen::Vector2i& hit,
               const Evidence& evidence) {
  bool is_stopped = false;
  for_each_cell_before(from, hit, [&](const Eigen::Vector2i& cell) {
    is_stopped = is_stopped || before.is_occupied(cell);
    if (is_stopped || !before.is_unknown(cell)) return;
    MrptGrid::updateCell_fast_free(grid.getRow(cell.y()) + cell.x(), evidence.free, evidence.free_limit);
  });
  if (is_stopped || !before.is_unknown(hit)) return;
  MrptGrid::updateCell_fast_occupied(grid.getRow(hit.y()) + hit.x(), evidence.occupied, evidence.occupied_limit);
}

GridMap picture_of(const MrptGrid& grid, const Extent& extent, double resolution_m) {
  GridMap map;
  map.resolution_m = resolution_m;
  map.origin_m = {extent.left * resolution_m, extent.bottom * resolution_m};
  map.width_cells = static_cast<int>(extent.width());
  map.height_cells = static_cast<int>(extent.height());
  map.grey.reserve(static_cast<std::size_t>(map.width_cells) * static_cast<std::size_t>(map.height_cells));
  for (int y = map.height_cells - 1; y >= 0; --y) {
    const MrptGrid::cellType* row = grid.getRow(y);
    std::transform(row, row + map.width_cells, std::back_inserter(map.grey),
                   [](MrptGrid::cellType log_odds) { return MrptGrid::l2p_255(log_odds); });
  }
  return map;
}

}  // namespace

Eigen::Vector2i GridMap::pixel_at(const Point2& p_in_map_m) const {
  const Point2 cell = (p_in_map_m - origin_m) / resolution_m;
  return {static_cast<int>(std::floor(cell.x())), height_cells - 1 - static_cast<int>(std::floor(cell.y()))};
}

GridMap build_grid_map(const Log& log, const std::vector<PlacedPosition>& placed, const ReturnOptions& returns,
                       const GridMapOptions& options) {
  validate(options);
  if (placed.empty()) throw OutputError("no position has a pose, so there is no map to draw");
  const double resolution_m = options.resolution_m;
  const AllRays all = rays_in_map(log, placed, returns, options.contradicting);
  const Extent extent = extent_of(all, placed, resolution_m);
  check_size(extent, resolution_m);

  // Cells of side 1: MRPT keeps limits as 32-bit floats, which whole numbers survive.
  MrptGrid grid;
  grid.setSize(0.0F, static_cast<float>(extent.width()), 0.0F, static_cast<float>(extent.height()), 1.0F);
  const auto cell_of = [&](const Point2& p_m) {
    return Eigen::Vector2i(static_cast<int>(std::floor(p_m.x() / resolution_m) - extent.left),
                           static_cast<int>(std::floor(p_m.y() / resolution_m) - extent.bottom));
  };
  const Evidence evidence;
  for (const Rays& rays : all.plain) {
    const Eigen::Vector2i from = cell_of(rays.from_m);
    for (const Point2& hit_m : rays.hits_m) insert_ray(grid, from, cell_of(hit_m), evidence);
  }
  if (!all.contradicting.empty()) {
    const GridBefore before(grid);
    for (const Rays& rays : all.contradicting) {
      const Eigen::Vector2i from = cell_of(rays.from_m);
      for (const Point2& hit_m : rays.hits_m) fill_gaps(grid, before, from, cell_of(hit_m), evidence);
    }
  }
  return picture_of(grid, extent, resolution_m);
}

}  // namespace shapemap
