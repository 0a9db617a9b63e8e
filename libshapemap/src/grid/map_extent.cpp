// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_extent.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <utility>

#include "rectangle_choice.hpp"

namespace shapemap {
namespace {

// rectangle_choice.cpp holds the other constants of the extent.
constexpr double kCellsPerRange = 8.0;  // in a usual range: neighbouring beams, and a wall seen twice, share a cell
constexpr double kSideBySide = 4.0;     // beam spacings between neighbours on a surface that is seen at a slant
constexpr double kInLine = 0.1;         // as a share of the range, off the line through the two points before or after
constexpr std::int64_t kSurfaceWorth = 10;  // a surface cell is worth so many cells of lone returns
constexpr double kMostCells = 1e9;          // points farther off are no map, and the size of the picture is refused

Box box_of_sensors(const std::vector<SeenRays>& seen, const std::vector<PlacedScan>& placed) {
  Box box;
  for (const PlacedScan& place : placed) box.include(place.map_from_robot.translation());
  for (const SeenRays& one : seen) box.include(one.rays.from_m);
  return box;
}

/// Returns the power of two at or below the median range, or 1 without any return.
double usual_range_m(const std::vector<SeenRays>& seen) {
  constexpr int kSmallest = -20;
  constexpr std::size_t kSampled = 8;  // every eighth return is enough
  std::array<std::size_t, 64> counts{};
  std::size_t total = 0;
  for (const SeenRays& one : seen) {
    for (std::size_t i = 0; i < one.rays.hits_m.size(); i += kSampled) {
      const int exponent = std::ilogb((one.rays.hits_m[i] - one.rays.from_m).squaredNorm()) >> 1;
      ++counts[static_cast<std::size_t>(std::clamp(exponent - kSmallest, 0, 63))];
      ++total;
    }
  }
  std::size_t below = 0;
  for (std::size_t i = 0; i < counts.size() && total > 0; ++i) {
    below += counts[i];
    if (2 * below >= total) return std::ldexp(1.0, static_cast<int>(i) + kSmallest);
  }
  return 1.0;
}

bool are_side_by_side(const Rays& rays, std::size_t i, std::size_t k) {
  const double spacing_m2 = rays.beam_step_rad * rays.beam_step_rad * (rays.hits_m[k] - rays.from_m).squaredNorm();
  return (rays.hits_m[k] - rays.hits_m[i]).squaredNorm() <= kSideBySide * kSideBySide * spacing_m2;
}

/// Says whether the line through points i and k meets the beam of point `at` near that point.
bool is_on_line(const Rays& rays, std::size_t i, std::size_t k, std::size_t at) {
  const Point2 along = rays.hits_m[k] - rays.hits_m[i];
  const Point2 to_line = rays.hits_m[i] - rays.from_m;
  const Point2 beam = rays.hits_m[at] - rays.from_m;
  const double line_share = along.x() * to_line.y() - along.y() * to_line.x();
  const double beam_share = along.x() * beam.y() - along.y() * beam.x();
  return std::abs(line_share - beam_share) <= kInLine * std::abs(line_share);
}

/// Along a wall that is seen at a low angle, neighbouring beams end far apart, but on one line.
bool is_in_line(const Rays& rays, std::size_t at) {
  return (at >= 2 && is_on_line(rays, at - 2, at - 1, at)) ||
         (at + 2 < rays.hits_m.size() && is_on_line(rays, at + 1, at + 2, at));
}

/// Finds which cells have returns, and what these are worth.
class CellWorths {
 public:
  /// `cell_m` is a power of two, so that its inverse is exact.
  explicit CellWorths(double cell_m) : cells_per_m_(1.0 / cell_m) {}

  CellIndex cell_of(const Point2& p_m) const {
    return {static_cast<std::int64_t>(std::floor(p_m.x() * cells_per_m_)),
            static_cast<std::int64_t>(std::floor(p_m.y() * cells_per_m_))};
  }

  void add(const SeenRays& seen) {
    const std::vector<Point2>& hits_m = seen.rays.hits_m;
    Cell* previous = nullptr;
    for (std::size_t i = 0; i < hits_m.size(); ++i) {
      Cell& cell = at(cell_of(hits_m[i]));
      if (!seen.contradicts_map) {
        cell.is_surface = cell.is_surface || (cell.visit != 0 && cell.visit != seen.visit);
        cell.visit = seen.visit;
        const bool is_news = i > 0 && !(previous->is_surface && cell.is_surface);
        if (is_news && are_side_by_side(seen.rays, i - 1, i)) previous->is_surface = cell.is_surface = true;
        if (!cell.is_surface && is_in_line(seen.rays, i)) cell.is_surface = true;
      }
      previous = &cell;
    }
  }

  std::vector<KnownCell> known() const {
    std::vector<KnownCell> known;
    known.reserve(cells_.size());
    for (const auto& [key, cell] : cells_) {
      const CellIndex index{key >> 32, static_cast<std::int32_t>(key & 0xFFFFFFFF)};
      known.push_back({index, cell.is_surface || is_seen_beside(index, cell) ? kSurfaceWorth : 1});
    }
    return known;
  }

 private:
  struct Cell {
    /// number of the last visit with a return here; 0 where only scans that contradict the map have one
    std::uint32_t visit = 0;
    bool is_surface = false;
  };
  using Entry = std::pair<const std::int64_t, Cell>;

  static std::int64_t key_of(const CellIndex& cell) {
    return (cell.x * (std::int64_t{1} << 32)) + static_cast<std::int64_t>(static_cast<std::uint32_t>(cell.y));
  }

  /// References stay valid when cells are added.
  Cell& at(const CellIndex& index) {
    const std::int64_t key = key_of(index);
    Entry*& recent = recent_[static_cast<std::size_t>((index.x & 31) * 32 + (index.y & 31))];
    if (!recent || recent->first != key) recent = &*cells_.try_emplace(key).first;
    return recent->second;
  }

  /// Says whether another visit saw this cell or one beside it.
  bool is_seen_beside(const CellIndex& index, const Cell& cell) const {
    if (cell.visit == 0) return false;
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        const auto beside = cells_.find(key_of({index.x + dx, index.y + dy}));
        if (beside != cells_.end() && beside->second.visit != 0 && beside->second.visit != cell.visit) return true;
      }
    }
    return false;
  }

  double cells_per_m_;
  std::unordered_map<std::int64_t, Cell> cells_;
  std::array<Entry*, 32 * 32> recent_{};  ///< the last cell of each residue of its indices, which spares most lookups
};

}  // namespace

Box box_of_all(const std::vector<SeenRays>& seen, const std::vector<PlacedScan>& placed) {
  Box box = box_of_sensors(seen, placed);
  for (const SeenRays& one : seen) {
    for (const Point2& hit_m : one.rays.hits_m) box.include(hit_m);
  }
  return box;
}

Box certain_box(const std::vector<SeenRays>& seen, const std::vector<PlacedScan>& placed, const Box& all) {
  const double cell_m = usual_range_m(seen) / kCellsPerRange;
  const double farthest_m = std::max(all.lower_m.cwiseAbs().maxCoeff(), all.upper_m.cwiseAbs().maxCoeff());
  if (placed.size() < 2 || seen.empty() || !(farthest_m / cell_m < kMostCells)) return all;
  Box box = box_of_sensors(seen, placed);
  CellWorths worths(cell_m);
  for (const SeenRays& one : seen) worths.add(one);
  const CellIndex lower = worths.cell_of(box.lower_m);
  const CellIndex upper = worths.cell_of(box.upper_m);
  const Rectangle scans{lower.x, upper.x, lower.y, upper.y};
  const std::optional<Rectangle> best = best_rectangle(worths.known(), scans, kCellsPerRange);
  if (!best) return all;
  for (const SeenRays& one : seen) {
    for (const Point2& hit_m : one.rays.hits_m) {
      if (best->holds(worths.cell_of(hit_m))) box.include(hit_m);
    }
  }
  return box;
}

}  // namespace shapemap
