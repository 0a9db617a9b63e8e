// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>
#include <vector>

#include "support/random_graph.hpp"
#include "support/ring_walk.hpp"

/// A robot stops along the ring and takes four sweeps at each stop, each with an error of its own.
namespace shapemap::test {

inline constexpr int kTurns = 4;

struct Stops {
  std::vector<Pose2> truth;
  std::vector<std::vector<Pose2>> robot_from_sweep;  ///< the errors
  Log log;
};

/// The stops are `apart_m` apart along the ring; sweeps of 100 degrees are turned by 90 degrees each.
inline Stops stops_on_ring(std::size_t count, double apart_m, unsigned seed, double error_m, double error_rad) {
  const World world = ring_world(1);
  std::mt19937 rng(seed);
  const Scanner scanner{201, 100.5 * kDegree, 0.01, 1, 20.0};
  Stops stops;
  for (std::size_t i = 0; i < count; ++i) {
    stops.truth.push_back(on_ring(apart_m * static_cast<double>(i)) * random_pose(rng, 0.1, 0.5));
    stops.robot_from_sweep.emplace_back();
    Scan scan;
    scan.timestamp_s = static_cast<double>(i);
    for (int turn = 0; turn < kTurns; ++turn) {
      const Pose2 nominal{0.0, 0.0, turn * kPi / 2};
      const Pose2 error = random_pose(rng, error_m, error_rad);
      stops.robot_from_sweep.back().push_back(error);
      Sweep sweep = scan_of(world, stops.truth.back() * error * nominal, scanner, rng).sweeps.front();
      sweep.nominal_heading_rad = nominal.theta_rad;
      scan.sweeps.push_back(std::move(sweep));
    }
    stops.log.scans.push_back(std::move(scan));
  }
  return stops;
}

/// Returns the root mean square heading error of the sweeps, apart from a turn that all of them share.
inline double heading_rms_rad(const Stops& stops, const std::vector<Pose2>& map_from_robot,
                              const std::vector<std::vector<Pose2>>& robot_from_sweep) {
  std::vector<double> off_rad;
  double sum_rad = 0.0;
  for (std::size_t i = 0; i < stops.truth.size(); ++i) {
    for (std::size_t s = 0; s < robot_from_sweep[i].size(); ++s) {
      const Pose2 found = map_from_robot[i] * robot_from_sweep[i][s];
      const Pose2 truth = stops.truth[i] * stops.robot_from_sweep[i][s];
      off_rad.push_back(
          wrap_angle(found.theta_rad - truth.theta_rad - map_from_robot[0].theta_rad + stops.truth[0].theta_rad));
      sum_rad += off_rad.back();
    }
  }
  double squares = 0.0;
  const auto count = static_cast<double>(off_rad.size());
  for (const double off : off_rad) squares += (off - sum_rad / count) * (off - sum_rad / count);
  return std::sqrt(squares / count);
}

}  // namespace shapemap::test
