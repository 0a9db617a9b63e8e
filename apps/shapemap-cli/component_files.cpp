// SPDX-License-Identifier: GPL-3.0-or-later
#include "component_files.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "map_picture.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/io/map_files.hpp"

namespace shapemap::cli {
namespace {

namespace fs = std::filesystem;

/// Recognises fragment_N.png, fragment_N.yaml, fragment_N.tum and fragment_N.LOG.tum.
bool is_fragment_name(const std::string& name) {
  const std::string begin = "fragment_";
  if (name.rfind(begin, 0) != 0) return false;
  const std::size_t end = name.find_first_not_of("0123456789", begin.size());
  if (end == begin.size() || end == std::string::npos || name[end] != '.') return false;
  const std::string ending = name.substr(end);
  return ending == ".png" || ending == ".yaml" || fs::path(name).extension() == ".tum";
}

std::vector<std::string> fragment_files_in(const std::string& folder) {
  std::vector<std::string> found;
  std::error_code error;
  const fs::directory_iterator end;
  for (fs::directory_iterator entry(folder, error); !error && entry != end; entry.increment(error)) {
    if (is_fragment_name(entry->path().filename().string())) found.push_back(entry->path().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

fs::path without_last_slash(const std::string& folder) { return (fs::path(folder) / "").parent_path(); }

[[noreturn]] void cannot_write(const std::string& folder, const std::string& why) {
  throw OutputError("cannot write fragments to '" + folder + "': " + why);
}

}  // namespace

void check_fragments_folder(const std::string& folder, const std::vector<std::string>& others, bool force) {
  std::error_code ignored;
  const fs::path plain = without_last_slash(folder);
  const fs::path parent = plain.has_parent_path() ? plain.parent_path() : fs::path(".");
  const bool exists = fs::exists(folder, ignored);
  if (exists && !fs::is_directory(folder, ignored)) cannot_write(folder, "it is no folder");
  if (!exists && !fs::is_directory(parent, ignored))
    cannot_write(folder, "there is no folder '" + parent.string() + "'");
  if (::access(exists ? folder.c_str() : parent.c_str(), W_OK | X_OK) != 0) cannot_write(folder, std::strerror(errno));
  for (const std::string& other : others) {
    const fs::path path(other);
    const std::string its_folder = path.has_parent_path() ? path.parent_path().string() : ".";
    if (other != "-" && is_fragment_name(path.filename().string()) && same_file(its_folder, folder)) {
      throw ConfigError("'" + other + "' has the name of a fragment; give it another, or --fragments another folder");
    }
    if (same_file(other, folder)) throw ConfigError("'" + other + "' is given for two outputs");
  }
  const std::vector<std::string> old = fragment_files_in(folder);
  if (!force && !old.empty()) throw OutputError("'" + old.front() + "' exists already; --force replaces it");
}

void add_component_files(const MapArguments& arguments, const LogSet& logs, const MapResult& result, OutputSet& outputs,
                         std::vector<DrawnComponent>& drawn) {
  const MapSettings& settings = arguments.settings;
  const fs::path folder = without_last_slash(arguments.fragments_folder);
  outputs.add_folder(folder.string());
  std::vector<std::string> written;
  const auto note = [&](const std::string& path) {
    written.push_back(path);
    return path;
  };
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    const std::vector<PlacedScan>& placed = result.components[i].scans;
    if (static_cast<int>(i) == result.largest_component || placed.empty()) continue;
    const std::string base = (folder / ("fragment_" + std::to_string(i))).string();
    const OccupancyGrid map = build_occupancy_grid(logs.log.scans, placed, settings.mapping.returns, settings.grid);
    drawn.push_back({static_cast<int>(i), map.num_returns, map.num_outside});
    add_map(note(base + ".png"), map, settings.drawing.draw_path ? &placed : nullptr, outputs);
    note(base + ".yaml");
    const std::vector<LogPart> parts = parts_of(logs.log);
    const std::vector<std::string> paths = per_log_paths(base + ".tum", arguments.logs);
    for (std::size_t k = 0; k < paths.size(); ++k) {
      const std::vector<PlacedScan> part = placed_of(placed, parts.at(k));
      if (!part.empty()) outputs.add_text(note(paths[k]), tum_trajectory(part));
    }
  }
  for (const std::string& old : fragment_files_in(folder.string())) {
    if (std::find(written.begin(), written.end(), old) == written.end()) outputs.remove(old);
  }
}

}  // namespace shapemap::cli
