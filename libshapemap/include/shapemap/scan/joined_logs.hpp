// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/scan/scan.hpp"

/// Several logs, such as those of several robots, can make one map. Each of them is a session of its own.
namespace shapemap {

/// Concatenates the scans and warnings of the logs; Log::starts says where each session begins. The format is that of
/// all of them, or their formats joined by "+".
Log joined_logs(std::vector<Log> logs);

/// A session has the scans [first, last).
struct LogPart {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Returns the sessions of a log in order; a log that was not joined has one.
std::vector<LogPart> parts_of(const Log& log);

/// Returns the index of the session that scan `index` is from.
std::size_t part_with(const Log& log, std::size_t index);

/// Returns the index of the session of each scan, for those who know the scans but not their log.
std::vector<std::size_t> sessions_of(const Log& log);

}  // namespace shapemap
