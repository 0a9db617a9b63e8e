// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/shape/point_index.hpp"
#include "sweep_trajectory.hpp"

namespace shapemap {

/// A timed point is a return with the time of its beam on the clock of the trajectory.
struct TimedPoint {
  Point2 p_m;
  double time_s = 0.0;
  bool begins_line = false;
};

/// A timed sweep has all returns of one scan of the log.
struct TimedSweep {
  double stamp_s = 0.0;
  double first_s = 0.0;  ///< earliest time of its beams
  double last_s = 0.0;
  double turned_rad = 0.0;     ///< angle from its first beam to its last
  double usual_range_m = 0.0;  ///< median range of its returns
  std::vector<TimedPoint> points;
};

/// Says whether a trajectory bends a sweep implausibly: a motion against the beams, as fast as they go round, would lay
/// all of them on one line, and any scans would match.
bool is_implausible(const TimedSweep& sweep, const SweepTrajectory& trajectory);

/// A trajectory has placed and straightened this sweep.
struct PlacedSweep {
  std::vector<Point2> p_m;
  std::vector<Point2> normals;  ///< normals of the surfaces; zero where the neighbouring points do not tell them
  PointIndex index{{}};
};
PlacedSweep placed_sweep(const TimedSweep& sweep, const SweepTrajectory& trajectory);

/// Finds the nearest points of a sweep for one query after the other, using that the last result is near the next.
class SweepNeighbours {
 public:
  explicit SweepNeighbours(const PlacedSweep& sweep) : sweep_(sweep) {}

  PointIndex::Neighbour nearest(const Point2& p_m, double gate_m);

 private:
  const PlacedSweep& sweep_;
  std::size_t last_ = std::numeric_limits<std::size_t>::max();
};

/// Returns how badly successive sweeps match: the mean distance of the points of each to the surface that the other
/// saw, cut off where it says no more.
double sweep_misfit(const PlacedSweep& a, const PlacedSweep& b);

}  // namespace shapemap
