// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_picture.hpp"

#include <filesystem>

#include "shapemap/core/errors.hpp"
#include "shapemap/io/map_files.hpp"

namespace shapemap::cli {

void check_map_path(const std::string& option, const std::string& map_path) {
  const std::size_t dot = map_path.find_last_of("./");
  const std::string ending = dot == std::string::npos ? "" : map_path.substr(dot);
  if (dot == 0 || (dot != std::string::npos && map_path[dot - 1] == '/')) {
    throw ConfigError(option + " '" + map_path + "' has no name before its ending");
  }
  for (const char* known : {".png", ".pgm", ".tif", ".PNG", ".PGM", ".TIF"}) {
    if (ending == known) return;
  }
  throw ConfigError(option + " '" + map_path + "' must end in .png, .pgm or .tif");
}

std::string ros_yaml_path(const std::string& map_path) {
  return std::filesystem::path(map_path).replace_extension(".yaml").string();
}

void add_map(const std::string& map_path, const OccupancyGrid& map, const std::vector<PlacedScan>* path_to_draw,
             OutputSet& outputs) {
  outputs.add(map_path, [&](const std::string& path) { write_map_image(map, path, path_to_draw); });
  const std::string image_name = std::filesystem::path(map_path).filename().string();
  outputs.add_text(ros_yaml_path(map_path), ros_map_yaml(map, image_name));
}

}  // namespace shapemap::cli
