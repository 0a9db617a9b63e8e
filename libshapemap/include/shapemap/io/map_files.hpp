// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "shapemap/grid/occupancy_grid.hpp"

/// These functions write maps and trajectories in the formats of other tools.
namespace shapemap {

/// Writes .png, .pgm or .tif by the ending of `path`. With a path to draw, the picture also shows the scan poses, and a
/// strip above the map with a scale bar; the grey cells below stay what they are elsewhere. Throws OutputError.
void write_map_image(const OccupancyGrid& map, const std::string& path, const std::vector<PlacedScan>* path_to_draw);

/// Returns the map.yaml that ROS map_server reads, for the image called `image_name` beside it.
std::string ros_map_yaml(const OccupancyGrid& map, const std::string& image_name);

/// Returns TUM lines `t x y z qx qy qz qw`, one per placed scan. Throws OutputError for a pose or time beyond all
/// bounds.
std::string tum_trajectory(const std::vector<PlacedScan>& placed);

}  // namespace shapemap
