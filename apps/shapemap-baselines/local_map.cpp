// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_map.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap::baselines {
namespace {

struct CellCount {
  int ended = 0;
  int passed = 0;
  Eigen::Vector2f sum_m{0.0F, 0.0F};  ///< sum of the ends, from the corner of the grid
};

/// Counts beams per cell of the rectangle that holds them all.
class CountGrid {
 public:
  CountGrid(const std::vector<const std::vector<Beam>*>& scans, double cell_m) : cell_m_(cell_m) {
    const Beam& any = scans.front()->front();
    Point2 high = low_m_ = any.from_m;
    for (const std::vector<Beam>* beams : scans) {
      for (const Beam& beam : *beams) {
        low_m_ = low_m_.cwiseMin(beam.from_m).cwiseMin(beam.to_m);
        high = high.cwiseMax(beam.from_m).cwiseMax(beam.to_m);
      }
    }
    size_ = cell_of(high) + Eigen::Vector2i(1, 1);
    cells_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()));
  }

  /// Counts a beam, which passes through one cell for each step along its longer side.
  void count(const Beam& beam) {
    const Point2 way = (beam.to_m - beam.from_m) / cell_m_;
    const int steps = static_cast<int>(std::max(std::abs(way.x()), std::abs(way.y())));
    const Eigen::Vector2i end = cell_of(beam.to_m);
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector2i cell = cell_of(beam.from_m + (beam.to_m - beam.from_m) * i / steps);
      if (cell != end) ++at(cell).passed;
    }
    CellCount& hit = at(end);
    ++hit.ended;
    hit.sum_m += (beam.to_m - low_m_).cast<float>();
  }

  std::vector<OccupiedSpot> occupied_spots() const {
    std::vector<OccupiedSpot> spots;
    for (const CellCount& cell : cells_) {
      if (cell.ended == 0) continue;
      const Point2 middle_m = low_m_ + cell.sum_m.cast<double>() / cell.ended;
      spots.push_back({middle_m, static_cast<double>(cell.ended) / (cell.ended + cell.passed)});
    }
    return spots;
  }

 private:
  Eigen::Vector2i cell_of(const Point2& p_m) const {
    const Point2 place = (p_m - low_m_) / cell_m_;
    return {static_cast<int>(place.x()), static_cast<int>(place.y())};
  }
  CellCount& at(const Eigen::Vector2i& cell) {
    return cells_[static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(size_.x()) +
                  static_cast<std::size_t>(cell.x())];
  }

  double cell_m_;
  Point2 low_m_{0.0, 0.0};
  Eigen::Vector2i size_{0, 0};
  std::vector<CellCount> cells_;
};

}  // namespace

std::vector<Beam> beams_of(const Scan& scan, const ReturnOptions& returns, double max_range_m) {
  std::vector<Beam> beams;
  for (const Sweep& sweep : scan.sweeps) {
    const Point2 from_m = robot_from_sensor2(sweep).translation();
    for (const Return& hit : returns_in_robot(sweep, returns)) {
      if (hit.range_m <= max_range_m) beams.push_back({from_m, hit.p_in_robot_m});
    }
  }
  return beams;
}

void LocalMap::add(const Pose2& map_from_robot, const std::vector<Beam>& beams) {
  if (beams.empty()) return;
  const Turn turn(map_from_robot.theta_rad);
  std::vector<Beam> in_map;
  in_map.reserve(beams.size());
  for (const Beam& beam : beams) {
    in_map.push_back(
        {turn * beam.from_m + map_from_robot.translation(), turn * beam.to_m + map_from_robot.translation()});
  }
  scans_.push_back(std::move(in_map));
  if (scans_.size() > num_scans_) scans_.pop_front();
}

std::vector<OccupiedSpot> LocalMap::occupied_spots(const Point2& centre_m, double radius_m) const {
  std::vector<const std::vector<Beam>*> near;
  for (const std::vector<Beam>& beams : scans_) {
    if ((beams.front().from_m - centre_m).norm() < radius_m) near.push_back(&beams);
  }
  if (near.empty()) return {};
  CountGrid grid(near, cell_m_);
  for (const std::vector<Beam>* beams : near) {
    for (const Beam& beam : *beams) grid.count(beam);
  }
  return grid.occupied_spots();
}

}  // namespace shapemap::baselines
