// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/scan/scan.hpp"

/// Several logs that make one map, such as those of several robots.
namespace shapemap {

/// All positions and warnings, log after log; Log::starts says where each begins. Its format is that of all of them, or
/// their formats joined by "+".
Log joined_logs(std::vector<Log> logs);

/// The positions [first, last) of one of the logs that were joined.
struct LogPart {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// One for each log that was joined, in order; one for a log that was recorded as one.
std::vector<LogPart> parts_of(const Log& log);

/// Which of the joined logs position `index` is from.
std::size_t part_with(const Log& log, std::size_t index);

}  // namespace shapemap
