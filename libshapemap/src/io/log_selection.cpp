// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/log_selection.hpp"

#include <string>
#include <utility>

#include "shapemap/core/errors.hpp"

namespace shapemap {

Log select_scans(Log log, const SelectionOptions& options) {
  validate(options);
  const std::size_t num_scans = log.scans.size();
  const auto skip = static_cast<std::size_t>(options.skip);
  if (num_scans > 0 && skip >= num_scans) {
    throw ConfigError("--skip " + std::to_string(skip) + " leaves nothing of a log with " + std::to_string(num_scans) +
                      " positions");
  }
  std::vector<Scan> selected;
  for (std::size_t i = skip; i < num_scans; i += static_cast<std::size_t>(options.every)) {
    if (options.first > 0 && selected.size() == static_cast<std::size_t>(options.first)) break;
    selected.push_back(std::move(log.scans[i]));
  }
  log.scans = std::move(selected);
  return log;
}

std::size_t index_in_whole_log(std::size_t index, const SelectionOptions& options) {
  return static_cast<std::size_t>(options.skip) + index * static_cast<std::size_t>(options.every);
}

}  // namespace shapemap
