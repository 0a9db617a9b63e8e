// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/core/options.hpp"
#include "shapemap/core/pose2.hpp"

namespace shapemap {

/// These options say which scans become keyframes, and when keyframes are culled.
struct KeyframeOptions {
  double step_m = 0.50;
  double turn_rad = 20 * kDegree;
  int settle_at = 1000;

  /// Returns the tolerance within which a scan is at the place of a keyframe.
  PoseTolerance near() const { return {step_m, turn_rad}; }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"keyframe-step-m",
                "a scan nearer than this to a keyframe needs none of its own [m]; 0: each has its own", 0, 10},
          self.step_m);
    visit(Field{"keyframe-turn-deg", "unless it is turned by more [deg]", 0, 180, kDegree}, self.turn_rad);
    visit(Field{"cull-at",
                "when there are so many keyframes, loops are closed and those that are there twice let go; 0: never", 0,
                1000000}
              .formerly("settle-at"),
          self.settle_at);
  }
};

}  // namespace shapemap
