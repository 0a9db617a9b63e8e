// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "shapemap/core/errors.hpp"
#include "shapemap/core/observer.hpp"
#include "shapemap/deskew/deskew.hpp"
#include "shapemap/io/log_file.hpp"
#include "shapemap/mapper/map_log.hpp"

/// Logs that may hold anything are read and mapped here.
namespace shapemap::test {

enum class Outcome { kMapped, kRefused };

/// Reads the file, straightens the sweeps of its first scans and maps three of them. Whatever it holds, this ends with
/// a result or an InputError; all else is a fault.
inline Outcome read_and_map(const std::string& path) {
  constexpr std::size_t kStraightened = 8;
  constexpr std::size_t kFirst = 3;
  LogReadOptions reading;
  reading.fov_rad = kPi;  // bare numbers need it
  try {
    Log log = read_log(path, LogFormat::kAuto, reading);
    summarise(log);
    log.scans.resize(std::min(log.scans.size(), kStraightened));
    MappingOptions options;
    options.run.threads = 1;
    MappingEvents observer;
    log = straightened(std::move(log), options.returns, options.deskew, 1, {1, observer}).log;
    log.scans.resize(std::min(log.scans.size(), kFirst));
    map_log(log, options, observer);
    return Outcome::kMapped;
  } catch (const InputError&) {
    return Outcome::kRefused;
  }
}

}  // namespace shapemap::test
