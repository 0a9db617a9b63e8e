// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/grid/occupancy_grid.hpp"
#include "shapemap/grid/wall_direction.hpp"
#include "shapemap/io/log_file.hpp"
#include "shapemap/io/log_selection.hpp"
#include "shapemap/mapper/mapper_options.hpp"

namespace shapemap::cli {

struct DrawOptions {
  bool draw_path = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"draw-path", "draw the positions and a scale bar into the map"}, self.draw_path);
  }
};

/// The options file holds these settings, but no paths of inputs and outputs.
struct MapSettings {
  LogReadOptions reading;
  SelectionOptions selection;
  MappingOptions mapping;
  WallOptions walls;
  OccupancyGridOptions grid;
  DrawOptions drawing;

  template <class Self, class Visit>
  static void groups(Self& self, Visit&& visit) {
    visit("Reading", self.reading);
    visit("Selection", self.selection);
    MappingOptions::groups(self.mapping, visit);
    visit("Walls", self.walls);
    visit("Map", self.grid);
    visit("Drawing", self.drawing);
  }
};

}  // namespace shapemap::cli
