// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/grid/scan_consistency.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "shapemap/core/grid_line.hpp"
#include "shapemap/grid/placed_rays.hpp"
#include "shapemap/grid/visits.hpp"
#include "visit_grid.hpp"

namespace shapemap {
namespace {

constexpr double kFarthestCell = 1e8;      // points farther off are no map, and would not fit the grid's numbers
constexpr double kBesideSensor_m = 0.5;    // in a doorway, a jamb that is a little off hides half of the view
constexpr int kBeforeHit = 1;              // in cells: a surface is rough, and its range noisy
constexpr std::uint32_t kSurfaceOdds = 4;  // a thin or mirroring surface stops at least every fourth visit
constexpr std::uint32_t kWallOdds = 4;     // and a wall nearly all of them: others are glass, or edges

struct CellRays {
  Eigen::Vector2i from;
  std::vector<Eigen::Vector2i> hits;
};

enum class BeamFate { kUnknown, kAgree, kThrough, kInFree };

class Judge {
 public:
  Judge(const std::vector<Scan>& scans, const std::vector<PlacedScan>& placed, const ReturnOptions& returns,
        const ConsistencyOptions& options)
      : scans_(scans),
        placed_(placed),
        returns_(returns),
        options_(options),
        reach_(static_cast<int>(std::lround(options.tolerance_m / options.cell_m))),
        beside_(static_cast<int>(std::lround(kBesideSensor_m / options.cell_m))),
        min_visits_(static_cast<std::uint32_t>(options.min_visits)) {}

  std::vector<ScanConsistency> run() {
    const std::vector<std::size_t> starts = starts_of_visits(placed_);
    for (std::size_t i = 0; i + 1 < starts.size(); ++i) draw(starts[i], starts[i + 1], number_of(i));
    std::vector<ScanConsistency> all;
    for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
      // The visit is drawn once more, so that its own marks are the last ones and can be told from the others'.
      draw_own(starts[i], starts[i + 1], number_of(i));
      for (std::size_t k = starts[i]; k < starts[i + 1]; ++k) all.push_back(judged(placed_[k], number_of(i)));
    }
    return all;
  }

 private:
  static std::uint32_t number_of(std::size_t visit) { return static_cast<std::uint32_t>(visit + 1); }

  bool is_on_grid(const Point2& p_m) const {
    return p_m.cwiseAbs().maxCoeff() / options_.cell_m < kFarthestCell;  // false for NaN
  }

  Eigen::Vector2i cell_of(const Point2& p_m) const {
    return {static_cast<int>(std::floor(p_m.x() / options_.cell_m)),
            static_cast<int>(std::floor(p_m.y() / options_.cell_m))};
  }

  std::vector<CellRays> rays_in_cells(const PlacedScan& place) const {
    std::vector<CellRays> all;
    for (const Rays& rays : rays_of(scans_, place, returns_)) {
      if (!is_on_grid(rays.from_m)) continue;
      CellRays cells{cell_of(rays.from_m), {}};
      for (const Point2& hit_m : rays.hits_m) {
        if (is_on_grid(hit_m)) cells.hits.push_back(cell_of(hit_m));
      }
      all.push_back(std::move(cells));
    }
    return all;
  }

  template <class Pass, class Hit>
  void trace(std::size_t first, std::size_t last, const Pass& pass, const Hit& hit) {
    for (std::size_t k = first; k < last; ++k) {
      for (const CellRays& rays : rays_in_cells(placed_[k])) {
        for (const Eigen::Vector2i& end : rays.hits) {
          for_each_cell_before(rays.from, end, [&](const Eigen::Vector2i& cell) {
            if ((end - cell).cwiseAbs().maxCoeff() > kBeforeHit) pass(grid_.at(cell));
          });
          hit(grid_.at(end));
        }
      }
    }
  }

  void draw(std::size_t first, std::size_t last, std::uint32_t visit) {
    trace(
        first, last, [visit](VisitCell& cell) { cell.pass(visit); }, [visit](VisitCell& cell) { cell.hit(visit); });
  }

  void draw_own(std::size_t first, std::size_t last, std::uint32_t visit) {
    trace(
        first, last, [visit](VisitCell& cell) { cell.last_pass = visit; },
        [visit](VisitCell& cell) { cell.last_hit = visit; });
  }

  /// Says whether nearly all other visits that reached the cell ended there.
  bool is_wall(const Eigen::Vector2i& at, std::uint32_t visit) {
    const VisitCell& cell = grid_.seen(at);
    const std::uint32_t hits = cell.other_hits(visit);
    return hits >= min_visits_ && hits >= kWallOdds * cell.other_passes(visit);
  }

  std::uint32_t hits_around(const Eigen::Vector2i& at, int reach, std::uint32_t visit) {
    std::uint32_t hits = 0;
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) hits += grid_.seen(at + Eigen::Vector2i(x, y)).other_hits(visit);
    }
    return hits;
  }

  /// Says whether the beam meets a surface, leaves it behind and ends farther on. Beams that graze a wall which is a
  /// little off run beside it to their end, and do not leave it.
  bool goes_through(const Eigen::Vector2i& from, const Eigen::Vector2i& end, std::uint32_t visit) {
    bool met = false;
    bool through = false;
    for_each_cell_before(from, end, [&](const Eigen::Vector2i& cell) {
      if (through || (end - cell).cwiseAbs().maxCoeff() <= 2 * reach_) return;
      if (!met) {
        met = (cell - from).cwiseAbs().maxCoeff() >= beside_ && is_wall(cell, visit);
      } else {
        through = hits_around(cell, reach_, visit) == 0;
      }
    });
    return through;
  }

  BeamFate fate_of(const Eigen::Vector2i& from, const Eigen::Vector2i& end, std::uint32_t visit) {
    if (goes_through(from, end, visit)) return BeamFate::kThrough;
    const std::uint32_t hits = hits_around(end, reach_, visit);
    const std::uint32_t passes = grid_.seen(end).other_passes(visit);
    if (hits > 0 && kSurfaceOdds * hits >= passes) return BeamFate::kAgree;
    return passes >= min_visits_ ? BeamFate::kInFree : BeamFate::kUnknown;
  }

  ScanConsistency judged(const PlacedScan& place, std::uint32_t visit) {
    ScanConsistency consistency;
    std::size_t beams = 0;
    for (const CellRays& rays : rays_in_cells(place)) {
      for (const Eigen::Vector2i& end : rays.hits) {
        const BeamFate fate = fate_of(rays.from, end, visit);
        if (fate == BeamFate::kAgree) consistency.agree += 1.0;
        if (fate == BeamFate::kThrough) consistency.through += 1.0;
        if (fate == BeamFate::kInFree) consistency.in_free += 1.0;
        ++beams;
      }
    }
    if (beams == 0) return consistency;
    for (double* share : {&consistency.agree, &consistency.through, &consistency.in_free}) {
      *share /= static_cast<double>(beams);
    }
    const double against = consistency.through + consistency.in_free;
    consistency.contradicts_map =
        consistency.known() >= options_.min_known_share && against > options_.contradicting_share * consistency.known();
    return consistency;
  }

  const std::vector<Scan>& scans_;
  const std::vector<PlacedScan>& placed_;
  const ReturnOptions& returns_;
  const ConsistencyOptions& options_;
  int reach_;   ///< the tolerance, in cells
  int beside_;  ///< in cells; surfaces nearer to a sensor are not judged from its own place
  std::uint32_t min_visits_;
  VisitGrid grid_;
};

}  // namespace

std::vector<ScanConsistency> scan_consistencies(const std::vector<Scan>& scans, const std::vector<PlacedScan>& placed,
                                                const ReturnOptions& returns, const ConsistencyOptions& options) {
  validate(options);
  return Judge(scans, placed, returns, options).run();
}

void judge_consistency(const std::vector<Scan>& scans, const ReturnOptions& returns, const ConsistencyOptions& options,
                       std::vector<Component>& components) {
  for (Component& component : components) {
    const std::vector<ScanConsistency> consistencies = scan_consistencies(scans, component.scans, returns, options);
    for (std::size_t i = 0; i < consistencies.size(); ++i) component.scans[i].consistency = consistencies[i];
  }
}

}  // namespace shapemap
