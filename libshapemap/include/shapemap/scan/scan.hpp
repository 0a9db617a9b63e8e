// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "shapemap/core/pose2.hpp"

/// Every log format is read into this plain model.
namespace shapemap {

/// The mount is the pose of a sensor on the robot: x forward, y left, z up; yaw, then pitch, then roll. A laser mounted
/// upside down has roll pi.
struct MountPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
};

/// A laser takes one sweep after the other. Angles are in the sensor's plane: 0 is the sensor's x axis,
/// counterclockwise is positive. Evenly spaced beams are the compact case: beam i points at `first_angle_rad + i *
/// angle_step_rad`, and the step is negative for a clockwise sensor. Other beams have an angle each, which
/// set_beam_angles() sets.
struct Sweep {
  std::vector<float> ranges_m;  ///< as recorded; NaN where the sensor itself says "no return"
  double first_angle_rad = 0.0;
  double angle_step_rad = 0.0;          ///< for uneven beams, the typical step
  std::vector<double> beam_angles_rad;  ///< one per reading where the beams are uneven, else empty
  double min_range_m = 0.0;             ///< shorter readings are no returns
  double max_range_m = 0.0;             ///< readings at or beyond it are no returns; 0 when the log states none
  MountPose robot_from_sensor;          ///< the mount while the robot faces its nominal heading
  double nominal_heading_rad = 0.0;  ///< turn of the robot, or of the sensor on it, since the first sweep of the scan
  std::string sensor_label;

  double start_s = 0.0;             ///< time of the first beam, counted from the scan's timestamp
  double beam_time_step_s = 0.0;    ///< from each beam to the next; 0 when the log does not state it
  std::vector<float> beam_times_s;  ///< one per reading, counted from the scan's timestamp, where the log has them
  std::vector<float> intensities;   ///< one per reading where the log has them, in the sensor's own unit

  bool is_evenly_spaced() const { return beam_angles_rad.empty(); }
  double beam_angle_rad(std::size_t beam) const {
    return is_evenly_spaced() ? first_angle_rad + static_cast<double>(beam) * angle_step_rad : beam_angles_rad[beam];
  }
  /// Returns the time of a beam, counted from the scan's timestamp.
  double beam_time_s(std::size_t beam) const {
    return beam_times_s.empty() ? start_s + static_cast<double>(beam) * beam_time_step_s : beam_times_s[beam];
  }
};

/// One scan is all sweeps that the robot took at one place; together they make a complete view.
struct Scan {
  double timestamp_s = 0.0;  ///< as in the log
  std::vector<Sweep> sweeps;
  std::optional<Pose2> reference_pose;  ///< surveyed pose, if the log has one; mapping never uses it
  /// The robot's own estimate of its heading, if the log has one. Mapping never uses it; it only tells whether the
  /// laser's scans are mirrored.
  std::optional<double> recorded_heading_rad;
};

/// A level is a distance, or a narrow band of them, that stands for "no return" in the readings of one sensor.
struct NoReturnLevel {
  std::string sensor_label;
  double from_m = 0.0;  ///< shortest reading on the level
  double to_m = 0.0;    ///< longest reading on the level
  std::size_t num_readings = 0;
  std::size_t log = 0;  ///< index of the session, where several logs were joined
};

struct Log {
  std::string format;  ///< "rawlog", "carmen", "nist" or "bare"
  std::vector<Scan> scans;
  /// Where several logs were joined, these are the first scans of all sessions but the first, in order.
  std::vector<std::size_t> starts;
  std::vector<std::string> warnings;      ///< oddities of the log that did not keep it from being read, one line each
  std::vector<NoReturnLevel> no_returns;  ///< levels that were learned when the log was read
  bool states_range_unit = false;         ///< the log states the unit of its ranges
};

}  // namespace shapemap
