// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <random>

#include "support/synthetic_world.hpp"

/// A rolling laser that moves while it goes round takes bent sweeps.
namespace shapemap::test {

using Motion = std::function<Pose2(double time_s)>;

struct RollingLaser {
  int num_beams = 120;
  double view_rad = 2 * kPi;
  double period_s = 0.1;
  double sweep_share = 1.0;  ///< share of its period that a sweep takes
  bool clockwise = false;
  double noise_m = 0.0;
  double max_range_m = 20.0;

  double beam_step_s() const { return sweep_share * period_s / num_beams; }
};

/// The laser swings about its heading by `yaw_rad` once a second, and walks along x.
inline Motion swinging(double yaw_rad, double speed_m_s = 0.0) {
  return [=](double time_s) { return Pose2{speed_m_s * time_s, 0.0, yaw_rad * std::sin(2 * kPi * time_s)}; };
}

/// Takes one sweep; each of its beams is sent from the pose of the laser at that time.
inline Scan bent_sweep(const World& world, const Motion& world_from_laser, double start_s, const RollingLaser& laser,
                       std::mt19937& rng) {
  std::normal_distribution<double> noise(0.0, 1.0);
  Scan scan;
  scan.timestamp_s = start_s;
  Sweep sweep;
  sweep.angle_step_rad = (laser.clockwise ? -1.0 : 1.0) * laser.view_rad / laser.num_beams;
  sweep.first_angle_rad = -0.5 * laser.num_beams * sweep.angle_step_rad + 0.5 * sweep.angle_step_rad;
  sweep.max_range_m = laser.max_range_m;
  for (int b = 0; b < laser.num_beams; ++b) {
    const Pose2 pose = world_from_laser(start_s + b * laser.beam_step_s());
    const double range_m =
        cast_ray_m(world, pose.translation(), pose.theta_rad + sweep.beam_angle_rad(static_cast<std::size_t>(b)));
    sweep.ranges_m.push_back(static_cast<float>(std::min(range_m + laser.noise_m * noise(rng), laser.max_range_m)));
  }
  scan.sweeps.push_back(std::move(sweep));
  return scan;
}

/// Takes sweeps that follow each other, with the true poses at their starts as references.
inline Log bent_log(const World& world, const Motion& world_from_laser, std::size_t num, const RollingLaser& laser = {},
                    unsigned seed = 1) {
  std::mt19937 rng(seed);
  Log log;
  for (std::size_t i = 0; i < num; ++i) {
    const double start_s = static_cast<double>(i) * laser.period_s;
    log.scans.push_back(bent_sweep(world, world_from_laser, start_s, laser, rng));
    log.scans.back().reference_pose = world_from_laser(start_s);
  }
  return log;
}

/// Returns the root mean square distance of returns from the walls, each sweep seen from its true pose.
inline double off_the_walls_m(const Log& log, const World& world) {
  double squares_m2 = 0.0;
  std::size_t num = 0;
  for (const Scan& scan : log.scans) {
    for (const Sweep& sweep : scan.sweeps) {
      for (const Return& hit : returns_in_robot(sweep, {})) {
        const double off_m = distance_to_walls_m(world, *scan.reference_pose * hit.p_in_robot_m);
        squares_m2 += off_m * off_m;
        ++num;
      }
    }
  }
  return std::sqrt(squares_m2 / static_cast<double>(num));
}

}  // namespace shapemap::test
