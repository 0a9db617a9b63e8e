// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>
#include <vector>

#include "likelihood_field.hpp"
#include "shapemap/scan/returns.hpp"

namespace shapemap::baselines {

/// A beam, in the robot's frame, ends at its return.
struct Beam {
  Point2 from_m;
  Point2 to_m;
};

/// Returns the beams of all sweeps of a scan that are not longer than `max_range_m`.
std::vector<Beam> beams_of(const Scan& scan, const ReturnOptions& returns, double max_range_m);

/// Counts what the latest scans have seen: the occupancy of a cell is the share of the beams that ended there among
/// those that reached it, so that things that moved away fade.
class LocalMap {
 public:
  LocalMap(std::size_t num_scans, double cell_m) : num_scans_(num_scans), cell_m_(cell_m) {}

  /// Adds a scan, and forgets the oldest one when there are too many.
  void add(const Pose2& map_from_robot, const std::vector<Beam>& beams);
  /// Returns one spot for each cell in which a beam ended, at the mean of these ends. Only scans taken less than
  /// `radius_m` from `centre_m` count.
  std::vector<OccupiedSpot> occupied_spots(const Point2& centre_m, double radius_m) const;

 private:
  std::size_t num_scans_;
  double cell_m_;
  std::deque<std::vector<Beam>> scans_;  ///< in the map frame; none is empty
};

}  // namespace shapemap::baselines
