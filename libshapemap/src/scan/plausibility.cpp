// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <sstream>
#include <utility>

#include "shapemap/core/errors.hpp"

namespace shapemap {
namespace {

using namespace plausible;

/// A number of a sweep has a largest plausible magnitude.
struct Bounded {
  const char* name;
  double value;
  double most;
  const char* unit;
  const char* expected;
};

std::string stated(const char* name, double value, const char* unit, const std::string& expected) {
  std::ostringstream text;
  text << name << " of " << value << unit << ", expected " << expected;
  return text.str();
}

/// Returns the fault of the first number out of its bounds. The comparison is written so that NaN is a fault.
std::string first_fault(std::initializer_list<Bounded> numbers) {
  for (const Bounded& number : numbers) {
    if (std::abs(number.value) <= number.most) continue;
    return stated(number.name, number.value, number.unit, number.expected);
  }
  return "";
}

/// Judges the directions of evenly spaced beams.
std::string fault_of_angles(const Sweep& sweep, std::size_t num_beams) {
  const double step_rad = std::abs(sweep.angle_step_rad);
  const std::string out_of_bounds =
      first_fault({{"first_angle", sweep.first_angle_rad, kMostScanAngle_rad, " rad", "at most two full turns"},
                   {"angle_step", sweep.angle_step_rad, 2.0 * kPi, " rad", "at most a full turn"}});
  if (!out_of_bounds.empty() || num_beams < 2) return out_of_bounds;
  if (step_rad < kLeastStep_rad) {
    return stated("angle_step", sweep.angle_step_rad, " rad",
                  "at least 1e-06 for a scan of " + std::to_string(num_beams) + " beams");
  }
  const double span_rad = step_rad * static_cast<double>(num_beams - 1);
  return first_fault(
      {{"an angle from the first beam to the last", span_rad, kMostScanAngle_rad, " rad", "at most two full turns"}});
}

/// Judges beams with an angle each. The even beams made of them later have a place for every step between the
/// outermost.
std::string fault_of_beam_angles(const Sweep& sweep) {
  for (const double angle_rad : sweep.beam_angles_rad) {
    if (std::abs(angle_rad) <= kMostScanAngle_rad) continue;  // written so that NaN is a fault
    return stated("a beam's angle", angle_rad, " rad", "at most two full turns");
  }
  const auto [lowest, highest] = std::minmax_element(sweep.beam_angles_rad.begin(), sweep.beam_angles_rad.end());
  const double step_rad = std::abs(sweep.angle_step_rad);
  if (step_rad == 0.0 || *highest - *lowest <= step_rad * static_cast<double>(kMostBeams)) return "";
  return stated("beams' angles with a step", step_rad, " rad", "at most a million steps from the first to the last");
}

/// Each list is empty or has an entry for each reading.
std::string fault_of_lists(const Sweep& sweep) {
  const std::size_t num_readings = sweep.ranges_m.size();
  for (const auto& [name, size] :
       {std::pair{"beam angles", sweep.beam_angles_rad.size()}, std::pair{"beam times", sweep.beam_times_s.size()},
        std::pair{"intensities", sweep.intensities.size()}}) {
    if (size == 0 || size == num_readings) continue;
    return std::to_string(size) + " " + name + ", expected none or " + std::to_string(num_readings);
  }
  return "";
}

std::string fault_of_times(const Sweep& sweep) {
  constexpr const char* kExpected = "at most a day from the position's timestamp";
  for (const float time_s : sweep.beam_times_s) {
    if (!(std::abs(static_cast<double>(time_s)) <= kMostSweep_s)) {
      return stated("a beam's time", static_cast<double>(time_s), " s", kExpected);
    }
  }
  return first_fault({{"the first beam's time", sweep.start_s, kMostSweep_s, " s", kExpected},
                      {"time_step", sweep.beam_time_step_s, kMostSweep_s, " s", kExpected}});
}

std::string fault_of_mount(const MountPose& mount) {
  constexpr const char* kLength = "at most 100 m from the robot's origin";
  constexpr const char* kAngle = "at most two full turns";
  return first_fault({{"a mount's x", mount.x_m, kMostMount_m, " m", kLength},
                      {"a mount's y", mount.y_m, kMostMount_m, " m", kLength},
                      {"a mount's z", mount.z_m, kMostMount_m, " m", kLength},
                      {"a mount's yaw", mount.yaw_rad, kMostScanAngle_rad, " rad", kAngle},
                      {"a mount's pitch", mount.pitch_rad, kMostScanAngle_rad, " rad", kAngle},
                      {"a mount's roll", mount.roll_rad, kMostScanAngle_rad, " rad", kAngle}});
}

/// Limits below 0 state no more than 0 does, so only the magnitude counts.
std::string fault_of_limits(const Sweep& sweep) {
  return first_fault({{"min_range", sweep.min_range_m, kMostMinRange_m, " m", "at most 1000 m"},
                      {"max_range", sweep.max_range_m, kMostMaxRange_m, " m", "a finite number, or 0 for none"},
                      {"heading", sweep.nominal_heading_rad, kMostHeading_rad, " rad", "at most a hundred turns"}});
}

}  // namespace

std::string implausibility(const Sweep& sweep, std::size_t num_beams) {
  if (num_beams > kMostBeams) return std::to_string(num_beams) + " beams, expected at most a million";
  for (const std::string& fault :
       {fault_of_lists(sweep),
        sweep.is_evenly_spaced() ? fault_of_angles(sweep, num_beams) : fault_of_beam_angles(sweep),
        fault_of_times(sweep), fault_of_mount(sweep.robot_from_sensor), fault_of_limits(sweep)}) {
    if (!fault.empty()) return fault;
  }
  return "";
}

std::string implausibility(const Sweep& sweep) { return implausibility(sweep, sweep.ranges_m.size()); }

std::string implausibility(const Pose2& pose) {
  return first_fault({{"x", pose.x_m, kMostCoordinate_m, " m", "at most 1e+09 m"},
                      {"y", pose.y_m, kMostCoordinate_m, " m", "at most 1e+09 m"},
                      {"heading", pose.theta_rad, kMostHeading_rad, " rad", "at most a hundred turns"}});
}

std::string implausible_time(double timestamp_s) {
  return first_fault({{"timestamp", timestamp_s, kMostTime_s, " s", "at most 1e+19 s"}});
}

std::string implausible_count(std::size_t num_before, const char* what) {
  if (num_before < kMostScans) return "";
  return "more than " + std::to_string(kMostScans) + " " + what + ", expected a log of fewer";
}

std::string implausibility(const Scan& scan) {
  std::string fault = implausible_time(scan.timestamp_s);
  if (fault.empty() && scan.reference_pose) {
    fault = implausibility(*scan.reference_pose);
    if (!fault.empty()) fault = "reference pose: " + fault;
  }
  if (fault.empty() && scan.recorded_heading_rad) {
    fault = first_fault(
        {{"the recorded heading", *scan.recorded_heading_rad, kMostHeading_rad, " rad", "at most a hundred turns"}});
  }
  for (std::size_t s = 0; fault.empty() && s < scan.sweeps.size(); ++s) {
    fault = implausibility(scan.sweeps[s]);
    if (!fault.empty() && scan.sweeps.size() > 1) fault = "sub-scan " + std::to_string(s) + ": " + fault;
  }
  return fault;
}

void require_plausible(const Log& log) {
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    const std::string fault = implausibility(log.scans[i]);
    if (!fault.empty()) throw InputError("position " + std::to_string(i) + ": " + fault);
  }
}

}  // namespace shapemap
