// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
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
struct Sweep {
  double stamp_s = 0.0;
  double first_s = 0.0;  ///< of its beams
  double last_s = 0.0;
  std::vector<TimedPoint> points;
};

/// A sweep as a trajectory places it: straight.
struct PlacedSweep {
  std::vector<Point2> p_m;
  std::vector<Point2> normals;  ///< of the surface; zero where its neighbours do not tell
  PointIndex index{{}};
};
PlacedSweep placed_sweep(const Sweep& sweep, const SweepTrajectory& trajectory);

struct SweepFitOptions {
  double first_gate_m = 0.5;
  double last_gate_m = 0.12;
  int iterations = 6;
  std::size_t stride = 1;  ///< each so manieth point looks for its partner
  int threads = 1;
};

/// How well successive sweeps go together: the mean over their points of the distance to the surface that the other
/// saw, cut off where it says no more.
double sweep_misfit(const PlacedSweep& a, const PlacedSweep& b);

/// Moves `trajectory` so that the points of each of the sweeps [first, last) lie on the surfaces that its neighbours
/// saw; what moves is what these sweeps depend on, but for control points below `first_free`.
void fit_sweeps(const std::vector<Sweep>& sweeps, std::size_t first, std::size_t last, std::size_t first_free,
                const SweepFitOptions& options, SweepTrajectory& trajectory);

}  // namespace shapemap
