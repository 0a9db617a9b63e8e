// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "place_verification.hpp"

namespace shapemap {

/// Which of several places of a map a stretch of the chain is at.
class PlaceHypotheses {
 public:
  /// True when it is the best so far.
  bool add(PlacedStretch laid);

  /// Whether it was tried at all with this keyframe of it, counted from its first, at this place.
  bool has(std::size_t keyframe, const Pose2& map_from_keyframe) const;

  /// Whether the best is right: not by itself only, but much more likely than any other that was tried.
  bool is_sure() const;
  const PlacedStretch& best() const { return tried_[best_]; }

 private:
  std::vector<PlacedStretch> tried_;
  std::size_t best_ = 0;
};

}  // namespace shapemap
