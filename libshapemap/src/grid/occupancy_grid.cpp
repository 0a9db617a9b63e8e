// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/grid/occupancy_grid.hpp"

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "map_extent.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/core/grid_line.hpp"
#include "shapemap/grid/placed_rays.hpp"
#include "shapemap/grid/visits.hpp"

namespace shapemap {
namespace {

using MrptGrid = mrpt::maps::COccupancyGridMap2D;

constexpr int kMarginCells = 4;           // so that walls at the rim stay visible
constexpr double kMaxCells = 400e6;       // one byte each here, up to four in a coloured picture
constexpr double kMaxCellsPerSide = 1e6;  // readers of pictures, including OpenCV, refuse wider ones

std::vector<SeenRays> seen_rays(const std::vector<Scan>& scans, const std::vector<PlacedScan>& placed,
                                const ReturnOptions& returns) {
  const std::vector<std::size_t> starts = starts_of_visits(placed);
  std::vector<SeenRays> seen;
  std::uint32_t visit = 0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (starts[visit] == i) ++visit;
    for (Rays& rays : rays_of(scans, placed[i], returns)) {
      seen.push_back({std::move(rays), visit, placed[i].consistency.contradicts_map});
    }
  }
  return seen;
}

/// An extent counts whole cells; cell (0, 0) has its lower left corner at the origin of the map frame.
struct Extent {
  double left = 0.0;
  double bottom = 0.0;
  double right = 0.0;
  double top = 0.0;

  Extent(const Box& box, double resolution_m)
      : left(std::floor(box.lower_m.x() / resolution_m) - kMarginCells),
        bottom(std::floor(box.lower_m.y() / resolution_m) - kMarginCells),
        right(std::floor(box.upper_m.x() / resolution_m) + kMarginCells),
        top(std::floor(box.upper_m.y() / resolution_m) + kMarginCells) {}

  double width() const { return right - left + 1.0; }
  double height() const { return top - bottom + 1.0; }
};

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

/// Evidence for a cell is in MRPT's log-odds of being free. The certainties are those of MRPT's own insertion.
struct Evidence {
  MrptGrid::cellType free = std::max<MrptGrid::cellType>(1, MrptGrid::p2l(0.65F));
  MrptGrid::cellType occupied = static_cast<MrptGrid::cellType>(3 * free);
  MrptGrid::cellType free_limit = static_cast<MrptGrid::cellType>(MrptGrid::OCCGRID_CELLTYPE_MAX - free);
  MrptGrid::cellType occupied_limit = static_cast<MrptGrid::cellType>(MrptGrid::OCCGRID_CELLTYPE_MIN + occupied);
};

/// This copy keeps the state of the grid before rays are drawn that must not change it.
class GridBefore {
 public:
  explicit GridBefore(const MrptGrid& grid) : width_(grid.getSizeX()) {
    for (std::size_t y = 0; y < grid.getSizeY(); ++y) {
      const MrptGrid::cellType* row = grid.getRow(static_cast<int>(y));
      cells_.insert(cells_.end(), row, row + width_);
    }
  }
  /// A cell is unknown where no beam came, or as many saw it free as occupied.
  bool is_unknown(const Eigen::Vector2i& cell) const { return at(cell) == 0; }
  bool is_occupied(const Eigen::Vector2i& cell) const { return at(cell) < 0; }

 private:
  MrptGrid::cellType at(const Eigen::Vector2i& cell) const {
    return cells_[static_cast<std::size_t>(cell.y()) * width_ + static_cast<std::size_t>(cell.x())];
  }
  std::size_t width_;
  std::vector<MrptGrid::cellType> cells_;
};

/// Draws beams into a part of the plane. All of them begin inside; those that end outside are drawn up to the rim.
class Canvas {
 public:
  Canvas(const Extent& extent, double resolution_m)
      : extent_(extent),
        resolution_m_(resolution_m),
        width_(static_cast<int>(extent.width())),
        height_(static_cast<int>(extent.height())) {
    // Cells have side 1 here: MRPT keeps limits as 32-bit floats, in which whole numbers are exact.
    grid_.setSize(0.0F, static_cast<float>(extent.width()), 0.0F, static_cast<float>(extent.height()), 1.0F);
  }

  Eigen::Vector2i cell_of(const Point2& p_m) const {
    return {static_cast<int>(std::floor(p_m.x() / resolution_m_) - extent_.left),
            static_cast<int>(std::floor(p_m.y() / resolution_m_) - extent_.bottom)};
  }
  bool holds(const Eigen::Vector2i& cell) const {
    return 0 <= cell.x() && cell.x() < width_ && 0 <= cell.y() && cell.y() < height_;
  }
  Point2 middle_of_m(const Eigen::Vector2i& cell) const {
    return resolution_m_ * Point2(extent_.left + cell.x() + 0.5, extent_.bottom + cell.y() + 0.5);
  }
  const MrptGrid& grid() const { return grid_; }

  /// Draws one beam along Bresenham's line: free up to the return, occupied there. MRPT's own insertion of a scan
  /// spaces n beams by aperture / n rather than aperture / (n - 1), does not know tilted lasers, and lets long rays
  /// drift off by a cell.
  void insert_ray(const Eigen::Vector2i& from, const Eigen::Vector2i& hit) {
    if (!holds(hit)) {
      while_cell_before(from, hit, [&](const Eigen::Vector2i& cell) { return holds(cell) && mark_free(cell); });
      return;
    }
    for_each_cell_before(from, hit, [&](const Eigen::Vector2i& cell) { mark_free(cell); });
    mark_occupied(hit);
  }

  /// Draws a beam only where nothing is known, and up to the first known surface.
  void fill_gaps(const GridBefore& before, const Eigen::Vector2i& from, const Eigen::Vector2i& hit) {
    bool comes_through = true;
    while_cell_before(from, hit, [&](const Eigen::Vector2i& cell) {
      comes_through = holds(cell) && fill_gap(before, cell);
      return comes_through;
    });
    if (comes_through && holds(hit) && before.is_unknown(hit)) mark_occupied(hit);
  }

  /// Draws a beam that hit nothing in the same way. It is no evidence of a gap in a wall, and stops also where two
  /// cells of one touch at a corner. Calls `visit` with each cell that was unknown.
  template <class Visit>
  void fill_open(const GridBefore& before, const Eigen::Vector2i& from, const Eigen::Vector2i& end,
                 const Visit& visit) {
    Eigen::Vector2i last = from;
    while_cell_before(from, end, [&](const Eigen::Vector2i& cell) {
      const bool slips_through = cell.x() != last.x() && cell.y() != last.y() &&
                                 before.is_occupied({cell.x(), last.y()}) && before.is_occupied({last.x(), cell.y()});
      if (slips_through || !fill_gap(before, cell)) return false;
      if (before.is_unknown(cell)) visit(cell);
      last = cell;
      return true;
    });
  }

 private:
  bool mark_free(const Eigen::Vector2i& cell) {
    MrptGrid::updateCell_fast_free(grid_.getRow(cell.y()) + cell.x(), evidence_.free, evidence_.free_limit);
    return true;
  }
  /// Returns false where a surface is known.
  bool fill_gap(const GridBefore& before, const Eigen::Vector2i& cell) {
    if (before.is_occupied(cell)) return false;
    return !before.is_unknown(cell) || mark_free(cell);
  }
  void mark_occupied(const Eigen::Vector2i& cell) {
    MrptGrid::updateCell_fast_occupied(grid_.getRow(cell.y()) + cell.x(), evidence_.occupied, evidence_.occupied_limit);
  }

  Extent extent_;
  double resolution_m_;
  int width_;
  int height_;
  Evidence evidence_;
  MrptGrid grid_;
};

/// Draws scans that contradict the rest of the map last, if the option asks for that.
void draw_hits(Canvas& canvas, const std::vector<SeenRays>& seen, Contradicting contradicting) {
  const auto draw = [&](const SeenRays& one, const auto& draw_beam) {
    const Eigen::Vector2i from = canvas.cell_of(one.rays.from_m);
    for (const Point2& hit_m : one.rays.hits_m) draw_beam(from, canvas.cell_of(hit_m));
  };
  const auto is_apart = [&](const SeenRays& one) {
    return contradicting == Contradicting::kFillGaps && one.contradicts_map;
  };
  for (const SeenRays& one : seen) {
    if (is_apart(one)) continue;
    draw(one, [&](const auto& from, const auto& hit) { canvas.insert_ray(from, hit); });
  }
  if (std::none_of(seen.begin(), seen.end(), is_apart)) return;
  const GridBefore before(canvas.grid());
  for (const SeenRays& one : seen) {
    if (!is_apart(one)) continue;
    draw(one, [&](const auto& from, const auto& hit) { canvas.fill_gaps(before, from, hit); });
  }
}

/// Calls `visit(from, end)` for each beam that hit nothing, of scans that are consistent with the rest of the map.
template <class Visit>
void for_each_open_ray(const std::vector<Scan>& scans, const std::vector<PlacedScan>& placed,
                       const ReturnOptions& returns, const OccupancyGridOptions& options, const Visit& visit) {
  if (!(options.clear_no_return_m > 0.0)) return;
  for (const PlacedScan& place : placed) {
    if (place.consistency.contradicts_map && options.contradicting == Contradicting::kFillGaps) continue;
    for (const OpenRays& rays : open_rays_of(scans, place, returns, options.clear_no_return_m)) {
      for (const Point2& end_m : rays.ends_m) visit(rays.from_m, end_m);
    }
  }
}

OccupancyGrid picture_of(const MrptGrid& grid, const Extent& of_grid, const Extent& extent, double resolution_m) {
  OccupancyGrid map;
  map.resolution_m = resolution_m;
  map.origin_m = {extent.left * resolution_m, extent.bottom * resolution_m};
  map.width_cells = static_cast<int>(extent.width());
  map.height_cells = static_cast<int>(extent.height());
  const int left = static_cast<int>(extent.left - of_grid.left);
  const int bottom = static_cast<int>(extent.bottom - of_grid.bottom);
  map.grey.reserve(static_cast<std::size_t>(map.width_cells) * static_cast<std::size_t>(map.height_cells));
  for (int y = map.height_cells - 1; y >= 0; --y) {
    const MrptGrid::cellType* row = grid.getRow(bottom + y) + left;
    std::transform(row, row + map.width_cells, std::back_inserter(map.grey),
                   [](MrptGrid::cellType log_odds) { return MrptGrid::l2p_255(log_odds); });
  }
  return map;
}

void count_returns(const std::vector<SeenRays>& seen, const Box& all, OccupancyGrid& map) {
  const auto is_inside = [&](const Point2& p_m) {
    const Eigen::Vector2i pixel = map.pixel_at(p_m);
    return 0 <= pixel.x() && pixel.x() < map.width_cells && 0 <= pixel.y() && pixel.y() < map.height_cells;
  };
  const bool is_whole = is_inside(all.lower_m) && is_inside(all.upper_m);
  for (const SeenRays& one : seen) {
    const std::vector<Point2>& hits_m = one.rays.hits_m;
    map.num_returns += hits_m.size();
    if (is_whole) continue;
    map.num_outside += hits_m.size() - static_cast<std::size_t>(std::count_if(hits_m.begin(), hits_m.end(), is_inside));
  }
}

}  // namespace

Eigen::Vector2i OccupancyGrid::pixel_at(const Point2& p_in_map_m) const {
  const Point2 cell = (p_in_map_m - origin_m) / resolution_m;
  return {static_cast<int>(std::floor(cell.x())), height_cells - 1 - static_cast<int>(std::floor(cell.y()))};
}

OccupancyGrid build_occupancy_grid(const std::vector<Scan>& scans, const std::vector<PlacedScan>& placed,
                                   const ReturnOptions& returns, const OccupancyGridOptions& options) {
  validate(options);
  if (placed.empty()) throw OutputError("no position has a pose, so there is no map to draw");
  const double resolution_m = options.resolution_m;
  const std::vector<SeenRays> seen = seen_rays(scans, placed, returns);
  const Box all = box_of_all(seen, placed);
  Box shown = options.draw_all ? all : certain_box(seen, placed, all);
  Box reached = shown;
  for_each_open_ray(scans, placed, returns, options, [&](const Point2& from_m, const Point2& end_m) {
    shown.include(from_m);
    reached.include(from_m);
    reached.include(end_m);
  });
  const Extent extent(reached, resolution_m);
  check_size(extent, resolution_m);

  Canvas canvas(extent, resolution_m);
  draw_hits(canvas, seen, options.contradicting);
  if (options.clear_no_return_m > 0.0) {
    const GridBefore before(canvas.grid());
    for_each_open_ray(scans, placed, returns, options, [&](const Point2& from_m, const Point2& end_m) {
      canvas.fill_open(before, canvas.cell_of(from_m), canvas.cell_of(end_m),
                       [&](const Eigen::Vector2i& cell) { shown.include(canvas.middle_of_m(cell)); });
    });
  }
  OccupancyGrid map = picture_of(canvas.grid(), extent, Extent(shown, resolution_m), resolution_m);
  count_returns(seen, all, map);
  return map;
}

}  // namespace shapemap
