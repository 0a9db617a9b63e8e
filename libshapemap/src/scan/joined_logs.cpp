// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/joined_logs.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace shapemap {

Log joined_logs(std::vector<Log> logs) {
  Log all;
  std::set<std::string> formats;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    Log& log = logs[k];
    const std::size_t first = all.scans.size();
    if (k > 0) all.starts.push_back(first);
    for (const std::size_t start : log.starts) all.starts.push_back(first + start);
    std::move(log.scans.begin(), log.scans.end(), std::back_inserter(all.scans));
    std::move(log.warnings.begin(), log.warnings.end(), std::back_inserter(all.warnings));
    for (NoReturnLevel& level : log.no_returns) {
      level.log += all.starts.size() - log.starts.size();
      all.no_returns.push_back(std::move(level));
    }
    if (formats.insert(log.format).second) all.format += (all.format.empty() ? "" : "+") + log.format;
  }
  return all;
}

std::vector<LogPart> parts_of(const Log& log) {
  std::vector<LogPart> parts{{0, log.scans.size()}};
  for (const std::size_t start : log.starts) {
    parts.back().last = start;
    parts.push_back({start, log.scans.size()});
  }
  return parts;
}

std::size_t part_with(const Log& log, std::size_t index) {
  return static_cast<std::size_t>(std::upper_bound(log.starts.begin(), log.starts.end(), index) - log.starts.begin());
}

std::vector<std::size_t> sessions_of(const Log& log) {
  std::vector<std::size_t> sessions;
  sessions.reserve(log.scans.size());
  const std::vector<LogPart> parts = parts_of(log);
  for (std::size_t k = 0; k < parts.size(); ++k) sessions.resize(parts[k].last, k);
  return sessions;
}

}  // namespace shapemap
