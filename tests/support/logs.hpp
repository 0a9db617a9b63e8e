// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "shapemap/core/errors.hpp"
#include "shapemap/io/log_file.hpp"
#include "shapemap/scan/returns.hpp"

namespace shapemap::test {

/// Returns the error of reading `path`, or "" when it can be read.
inline std::string input_error(const std::string& path, LogFormat format = LogFormat::kAuto,
                               const LogReadOptions& options = {}) {
  try {
    read_log(path, format, options);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// Makes a sweep whose readings are all different, with two that hit nothing.
inline Sweep make_sweep(std::size_t num_beams, double first_angle_rad, double angle_step_rad) {
  Sweep sweep;
  sweep.first_angle_rad = first_angle_rad;
  sweep.angle_step_rad = angle_step_rad;
  sweep.max_range_m = 20.0;
  sweep.sensor_label = "laser";
  for (std::size_t i = 0; i < num_beams; ++i) sweep.ranges_m.push_back(1.0F + 0.01F * static_cast<float>(i));
  sweep.ranges_m[1] = std::numeric_limits<float>::quiet_NaN();
  sweep.ranges_m[num_beams - 2] = 20.0F;
  return sweep;
}

/// Expects the same scans, times and points in the robot's frame.
inline void expect_same_points(const Log& a, const Log& b, double tolerance_m) {
  ASSERT_EQ(a.scans.size(), b.scans.size());
  for (std::size_t i = 0; i < a.scans.size(); ++i) {
    SCOPED_TRACE("scan " + std::to_string(i));
    const Scan& p = a.scans[i];
    const Scan& q = b.scans[i];
    // MRPT counts time in units of 100 ns.
    ASSERT_NEAR(p.timestamp_s, q.timestamp_s, 2e-7 + 1e-15 * std::abs(p.timestamp_s));
    ASSERT_EQ(p.sweeps.size(), q.sweeps.size());
    for (std::size_t s = 0; s < p.sweeps.size(); ++s) {
      const std::vector<Return> from_a = returns_in_robot(p.sweeps[s], {});
      const std::vector<Return> from_b = returns_in_robot(q.sweeps[s], {});
      ASSERT_EQ(from_a.size(), from_b.size());
      double worst_m = 0.0;
      for (std::size_t r = 0; r < from_a.size(); ++r) {
        worst_m = std::max(worst_m, (from_a[r].p_in_robot_m - from_b[r].p_in_robot_m).norm());
      }
      ASSERT_LT(worst_m, tolerance_m);
    }
  }
}

}  // namespace shapemap::test
