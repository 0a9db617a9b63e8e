// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "place_verification.hpp"

namespace shapemap {

/// Decides at which of several places of a map a stretch of successive keyframes is.
class PlaceHypotheses {
 public:
  /// Adds a place that was tried; returns true when it is the best so far.
  bool add(PlacedStretch laid);

  /// Returns whether a tried place puts this keyframe, counted from the first of the stretch, at this pose.
  bool has(std::size_t keyframe, const Pose2& map_from_keyframe) const;

  /// Returns whether the best place is likely in itself, and much likelier than any other that was tried.
  bool is_sure() const;
  const PlacedStretch& best() const { return tried_[best_]; }

 private:
  std::vector<PlacedStretch> tried_;
  std::size_t best_ = 0;
};

}  // namespace shapemap
