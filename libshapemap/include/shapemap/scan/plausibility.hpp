// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/scan.hpp"

/// These limits tell what no sensor can have recorded. One flipped bit turns an angle or a mount into an absurd number,
/// and with it every point that is computed from it. All readers and the mapper ask here, so that later stages need not
/// expect such numbers.
namespace shapemap {

/// The limits are wide: they keep out damaged numbers, never unusual ones.
namespace plausible {
/// Some lidars turn more than once for a sweep, and some turntables count their heading on over all turns.
inline constexpr double kMostScanAngle_rad = 2.0 * 2.0 * kPi;
inline constexpr double kMostHeading_rad = 100.0 * 2.0 * kPi;
/// The finest terrestrial scanners step by about 1e-5 rad; much less cannot be told from no step.
inline constexpr double kLeastStep_rad = 1e-6;
inline constexpr std::size_t kMostBeams = 1'000'000;
/// The largest vehicles are shorter than this.
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
/// A log that claims so many scans of two beams each needs less than 2 GiB of memory.
inline constexpr std::size_t kMostScans = 5'000'000;
}  // namespace plausible

/// Returns what makes a sweep of `num_beams` beams impossible, such as "angle_step of 1e+12 rad, expected at most a
/// full turn", or an empty string. The readings are not examined, since is_return() judges each of them.
std::string implausibility(const Sweep& sweep, std::size_t num_beams);
std::string implausibility(const Sweep& sweep);
/// Returns the fault of a pose or of a time that a log states, or an empty string.
std::string implausibility(const Pose2& pose);
std::string implausible_time(double timestamp_s);
/// Returns the fault of a log that has `num_before` scans, poses or sensors already when one more comes, or an empty
/// string.
std::string implausible_count(std::size_t num_before, const char* what);

/// Returns the first fault of a whole scan: of its time, its reference pose or one of its sweeps.
std::string implausibility(const Scan& scan);

/// Throws InputError, which names the first scan with a fault. Logs that no reader of the library made are checked this
/// way.
void require_plausible(const Log& log);

}  // namespace shapemap
