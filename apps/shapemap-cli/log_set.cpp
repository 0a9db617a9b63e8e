// SPDX-License-Identifier: GPL-3.0-or-later
#include "log_set.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "shapemap/core/errors.hpp"

namespace shapemap::cli {
namespace {

namespace fs = std::filesystem;

fs::path without_gz(const fs::path& path) {
  return path.extension() == ".gz" ? path.parent_path() / path.stem() : path;
}

Log read_one(const LogSource& source, const MapArguments& arguments) {
  const MapSettings& settings = arguments.settings;
  Log log = read_log(source.path, source.format, settings.reading);
  try {
    return select_scans(std::move(log), settings.selection);
  } catch (const ConfigError& e) {
    throw ConfigError(arguments.logs.size() == 1 ? e.what() : source.path + ": " + e.what());
  }
}

}  // namespace

std::string LogSet::scan_name(std::size_t index) const {
  const std::size_t which = part_with(log, index);
  const std::size_t first = which == 0 ? 0 : log.starts[which - 1];
  const std::string name = "position " + std::to_string(index_in_whole_log(index - first, selection));
  return is_one() ? name : name + " of " + files.at(which).path;
}

LogSet read_logs(const MapArguments& arguments) {
  LogSet set;
  set.selection = arguments.settings.selection;
  std::vector<Log> logs;
  for (const LogSource& source : arguments.logs) {
    logs.push_back(read_one(source, arguments));
    set.files.push_back({source.path, logs.back().format});
  }
  set.log = joined_logs(std::move(logs));
  return set;
}

std::vector<std::string> short_names(const std::vector<LogSource>& logs) {
  std::vector<std::string> names;
  for (const LogSource& log : logs) {
    const std::string stem = without_gz(log.path).stem().string();
    std::string name = stem;
    for (int i = 2; std::find(names.begin(), names.end(), name) != names.end(); ++i) {
      name = stem + "-" + std::to_string(i);
    }
    names.push_back(name);
  }
  return names;
}

std::vector<std::string> per_log_paths(const std::string& path, const std::vector<LogSource>& logs) {
  if (logs.size() == 1) return {path};
  const fs::path plain = without_gz(path);
  const std::string gz = plain == fs::path(path) ? "" : ".gz";
  std::vector<std::string> paths;
  for (const std::string& name : short_names(logs)) {
    const std::string file = plain.stem().string() + "." + name + plain.extension().string() + gz;
    paths.push_back((plain.parent_path() / file).string());
  }
  return paths;
}

std::vector<PlacedScan> placed_of(const std::vector<PlacedScan>& placed, const LogPart& part) {
  std::vector<PlacedScan> some;
  std::copy_if(placed.begin(), placed.end(), std::back_inserter(some),
               [&](const PlacedScan& place) { return part.first <= place.scan_index && place.scan_index < part.last; });
  return some;
}

}  // namespace shapemap::cli
