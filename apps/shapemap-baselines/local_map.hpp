// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <vector>

#include "likelihood_field.hpp"
#include "shapemap/scan/returns.hpp"

namespace shapemap::baselines {

/// A beam that hit something, in the robot's frame.
struct Beam {
  Point2 from_m;
  Point2 to_m;
};

/// The beams of all sub-scans of a position that are not longer than `max_range_m`.
std::vector<Beam> beams_of(const Scan& scan, const ReturnOptions& returns, double max_range_m);

/// What the latest scans have seen, by counting: each cell's occupancy is the share of the beams that ended there among
/// those that came so far, so that what walked away fades.
class LocalMap {
 public:
  LocalMap(std::size_t num_scans, double cell_m) : num_scans_(num_scans), cell_m_(cell_m) {}

  /// Forgets the oldest scan when there are too many.
  void add(const Pose2& map_from_robot, const std::vector<Beam>& beams);
  /// One spot for each cell in which a beam ended, in the middle of these ends. Only the scans count that were taken
  /// less than `radius_m` from `centre_m`.
  std::vector<OccupiedSpot> occupied_spots(const Point2& centre_m, double radius_m) const;

 private:
  std::size_t num_scans_;
  double cell_m_;
  std::deque<std::vector<Beam>> scans_;  ///< in the map's frame; none is empty
};

}  // namespace shapemap::baselines
