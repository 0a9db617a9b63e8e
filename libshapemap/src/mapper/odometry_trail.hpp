// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "front_end.hpp"
#include "shapemap/mapper/map.hpp"
#include "shapemap/mapper/mapper.hpp"

namespace shapemap {

/// Places scans by the matches from each keyframe to the next alone, and thereby in the latest map, before the map has
/// them.
class OdometryTrail {
 public:
  explicit OdometryTrail(const ConfidenceOptions& options) : options_(options) {}

  /// Adds the next scan. `map` is the latest one, or null.
  ScanUpdate add(const TrackedScan& scan, const Map* map);

 private:
  /// The pose of a scan in its stretch, which is what matches join to one first keyframe.
  struct Step {
    std::size_t stretch = 0;  ///< number of the stretch
    Pose2 stretch_from_robot;
    bool has_pose = false;
  };

  void match(const TrackedScan& scan, ScanUpdate& update);
  ScanPose in_map(const Step& step, const Map* map) const;

  const ConfidenceOptions& options_;
  std::vector<Step> steps_;  ///< one for each scan
  std::size_t last_keyframe_ = kNoReference;
  std::size_t num_stretches_ = 0;
};

}  // namespace shapemap
