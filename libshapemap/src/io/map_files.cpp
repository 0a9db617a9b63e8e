// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/map_files.hpp"

#include <cmath>
#include <cstdio>
#include <sstream>

#include "shapemap/core/errors.hpp"

namespace shapemap {
namespace {

/// Returns the shortest decimal that reads back as the same number.
std::string exact(double value) {
  char text[32];
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

/// Returns a double-quoted YAML scalar, which any file name can be.
std::string yaml_string(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02X", static_cast<unsigned>(c));
      quoted += escape;
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

}  // namespace

std::string ros_map_yaml(const OccupancyGrid& map, const std::string& image_name) {
  std::ostringstream yaml;
  yaml << "image: " << yaml_string(image_name) << "\n"
       << "resolution: " << exact(map.resolution_m) << "\n"
       << "origin: [" << exact(map.origin_m.x()) << ", " << exact(map.origin_m.y())
       << ", 0]\n"
       // Occupancy is (255 - grey) / 255, so that unknown cells have 0.5 and stay between the two limits.
       << "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n";
  return yaml.str();
}

std::string tum_trajectory(const std::vector<PlacedScan>& placed) {
  std::string lines;
  char line[256];
  for (const PlacedScan& place : placed) {
    const Pose2& pose = place.map_from_robot;
    const int length = std::snprintf(line, sizeof line, "%.9f %.9f %.9f 0 0 0 %.12f %.12f\n", place.timestamp_s,
                                     pose.x_m, pose.y_m, std::sin(pose.theta_rad / 2), std::cos(pose.theta_rad / 2));
    if (length < 0 || length >= static_cast<int>(sizeof line)) {
      throw OutputError("position " + std::to_string(place.scan_index) + " has a timestamp or pose beyond all bounds");
    }
    lines += line;
  }
  return lines;
}

}  // namespace shapemap
