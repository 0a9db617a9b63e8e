// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/core/options.hpp"
#include "shapemap/graph/keyframe_options.hpp"
#include "shapemap/inference/edge_verification.hpp"
#include "shapemap/inference/map_refinement.hpp"
#include "shapemap/inference/map_search.hpp"
#include "shapemap/inference/sweep_refinement.hpp"
#include "shapemap/loops/loop_detection.hpp"
#include "shapemap/matching/scan_matcher.hpp"

namespace shapemap {

/// This option says whether loops are closed.
struct LoopSwitch {
  bool close_loops = true;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"close-loops", "know places again; without it, errors add up along the way"}, self.close_loops);
  }
};

/// These options say how the robust method chooses and doubts odometry edges.
struct FrontEndOptions {
  double three_scan_weight = 0.5;
  double doubt_below = 0.3;
  int more_references = 2;
  double split_below = 0.7;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"three-scan-weight", "weight of how a pose goes with the scan before the last", 0, 10}.formerly(
              "companion-weight"),
          self.three_scan_weight);
    visit(
        Field{"lend-below", "a less probable alignment is helped by scans further back", 0, 1}.formerly("doubt-below"),
        self.doubt_below);
    visit(Field{"lending-keyframes", "so many of them", 0, 10}.formerly("more-references"), self.more_references);
    visit(Field{"split-below", "a less probable alignment that no loop holds splits the map instead", 0, 1},
          self.split_below);
  }
};

/// All options of the robust method, from the match of two scans to the whole map.
struct RobustOptions {
  MatcherOptions matcher;
  KeyframeOptions keyframes;
  FrontEndOptions front_end;
  LoopSwitch loops;
  LoopDetectionOptions loop_detection;
  MapSearchOptions map_search;
  RefinementOptions refinement;
  EdgeVerificationOptions edge_verification;
  SweepRefinementOptions sweep_refinement;
};

}  // namespace shapemap
