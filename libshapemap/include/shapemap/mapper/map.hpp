// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "shapemap/core/pose2.hpp"
#include "shapemap/graph/closed_loop.hpp"

/// These types hold the map while it grows, and its changes.
namespace shapemap {

/// Maps are numbered from 1 on, in the order in which they are made; 0 is before the first.
using MapVersion = std::uint64_t;

/// The pose of a scan in a map.
struct ScanPose {
  int component = -1;    ///< index of the component that the scan is in; -1: the scan has no pose
  Pose2 map_from_robot;  ///< in the frame of the component, which is the robot's frame at the component's first scan

  bool operator==(const ScanPose& other) const {
    return component == other.component && map_from_robot == other.map_from_robot;
  }
  bool operator!=(const ScanPose& other) const { return !(*this == other); }
};

/// A map of the scans that had been pushed when it was made; it never changes.
struct Map {
  MapVersion version = 0;
  std::vector<ScanPose> scans;         ///< the poses of the first scans that were pushed, by number of scan
  std::vector<std::size_t> keyframes;  ///< the scans that others are matched to, in order
  std::vector<ClosedLoop> loops;       ///< loops between scans, strongest first
  int num_components = 0;
  bool is_final = false;  ///< whether Mapper::finish() made the map
};

/// The new pose of a scan that differs from its pose in the map before.
struct Correction {
  std::size_t scan = 0;
  ScanPose pose;
};

/// The changes of the map since an earlier version.
struct Corrections {
  MapVersion version = 0;               ///< the version to ask from next time
  std::vector<Correction> corrections;  ///< one for each scan that has moved, in the order of scans
};

}  // namespace shapemap
