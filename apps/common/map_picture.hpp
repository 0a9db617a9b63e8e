// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "output_set.hpp"
#include "shapemap/grid/occupancy_grid.hpp"

/// A map is written as a picture with a map.yaml beside it.
namespace shapemap::cli {

/// Throws ConfigError when the file that `option` gives is no picture that can be written.
void check_map_path(const std::string& option, const std::string& map_path);

/// Returns the path of the map.yaml beside the picture.
std::string ros_yaml_path(const std::string& map_path);

/// Prepares both files; `path_to_draw` may be null.
void add_map(const std::string& map_path, const OccupancyGrid& map, const std::vector<PlacedScan>* path_to_draw,
             OutputSet& outputs);

}  // namespace shapemap::cli
