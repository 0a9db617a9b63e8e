// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/shape/point_index.hpp"
#include "sweep_trajectory.hpp"

namespace shapemap {

/// A hit and when its beam was sent, on the clock of the trajectory.
struct TimedPoint {
  Point2 p_m;
  double time_s = 0.0;
  bool begins_line = false;
};

/// All hits of one position of the log.
struct TimedSweep {
  double stamp_s = 0.0;
  double first_s = 0.0;  ///< of its beams
  double last_s = 0.0;
  double turned_rad = 0.0;     ///< by its beams, from the first to the last
  double usual_range_m = 0.0;  ///< half of its hits are nearer
  std::vector<TimedPoint> points;
};

/// Whether a trajectory bends a sweep so much that what it shows is no place: a motion against the beams, as fast as
/// they go round, would lay all of them on one line, and any scans would go together.
bool is_wild(const TimedSweep& sweep, const SweepTrajectory& trajectory);

/// A sweep as a trajectory places it: straight.
struct PlacedSweep {
  std::vector<Point2> p_m;
  std::vector<Point2> normals;  ///< of the surface; zero where its neighbours do not tell
  PointIndex index{{}};
};
PlacedSweep placed_sweep(const TimedSweep& sweep, const SweepTrajectory& trajectory);

/// Finds the nearest of a sweep's points for one point after the other: what was found last is near the next.
class SweepNeighbours {
 public:
  explicit SweepNeighbours(const PlacedSweep& sweep) : sweep_(sweep) {}

  PointIndex::Neighbour nearest(const Point2& p_m, double gate_m);

 private:
  const PlacedSweep& sweep_;
  std::size_t last_ = std::numeric_limits<std::size_t>::max();
};

/// How well successive sweeps go together: the mean over their points of the distance to the surface that the other
/// saw, cut off where it says no more.
double sweep_misfit(const PlacedSweep& a, const PlacedSweep& b);

}  // namespace shapemap
