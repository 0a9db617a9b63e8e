// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/scan.hpp"

/// What no sensor can have recorded. One flipped bit turns an angle or a mount into a number that is far from all
/// sense, and with it every point that is computed from it. All readers and the mapping itself ask here, so that none
/// of what comes after needs to expect such numbers.
namespace shapemap {

/// The limits are wide: they keep out what is damaged, never what is unusual.
namespace plausible {
/// Lidars that turn more than once for a scan are known; a heading may be counted on over all turns of a turntable.
inline constexpr double kMostScanAngle_rad = 2.0 * 2.0 * kPi;
inline constexpr double kMostHeading_rad = 100.0 * 2.0 * kPi;
/// The finest terrestrial scanners step by about 1e-5 rad; much less cannot be told from no step.
inline constexpr double kLeastStep_rad = 1e-6;
inline constexpr std::size_t kMostBeams = 1'000'000;
/// The largest vehicles are shorter.
inline constexpr double kMostMount_m = 100.0;
/// A maximum range of FLT_MAX is a driver's way to say that there is none.
inline constexpr double kMostMaxRange_m = 3.5e38;
inline constexpr double kMostMinRange_m = 1000.0;
/// The slowest scanners take hours for a sweep.
inline constexpr double kMostSweep_s = 1e5;
/// Map grids put the origin up to 1e7 m away.
inline constexpr double kMostCoordinate_m = 1e9;
/// Nanoseconds in a 64-bit counter, taken for seconds, are harmless.
inline constexpr double kMostTime_s = 1e19;
/// Memory that a log of scans with two beams each may ask for stays below 2 GiB.
inline constexpr std::size_t kMostScans = 5'000'000;
}  // namespace plausible

/// What makes a scan of `num_beams` beams impossible, such as "angle_step of 1e+12 rad, expected at most a full turn";
/// empty when nothing does. The readings are not looked at: is_return() judges each by itself.
std::string implausibility(const Sweep& sweep, std::size_t num_beams);
std::string implausibility(const Sweep& sweep);
/// The same of a pose that a log states, and of a time.
std::string implausibility(const Pose2& pose);
std::string implausible_time(double timestamp_s);
/// The same of a log that has `num_before` scans, positions or sensors already, when one more comes.
std::string implausible_count(std::size_t num_before, const char* what);

/// The first fault of a whole position: its time, its reference pose or one of its sub-scans.
std::string implausibility(const Scan& scan);

/// Throws InputError that names the first position with a fault. For logs that come from elsewhere than a reader.
void require_plausible(const Log& log);

}  // namespace shapemap
