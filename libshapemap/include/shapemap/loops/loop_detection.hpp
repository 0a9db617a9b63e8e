// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "shapemap/core/execution.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/loops/loop_clusters.hpp"
#include "shapemap/matching/match_cache.hpp"

/// Where places may have been seen before.
namespace shapemap {

struct LoopDetectionOptions {
  int likely_places = 6;
  int shortest_loop = 10;
  double least_probability = 0.02;
  double bridge_below = 0.5;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"loop-likely-places", "earlier places that look most alike and are tried, for each", 0, 10000},
          self.likely_places);
    visit(Field{"loop-shortest", "a loop joins keyframes that are at least so many apart", 2, 10000},
          self.shortest_loop);
    visit(Field{"loop-least-probability", "a less probable alignment is not considered for a loop", 0, 1},
          self.least_probability);
    visit(Field{"cross-match-below",
                "about a less probable alignment of the chain, all scans are aligned to each other", 0, 1}
              .formerly("loop-bridge-below"),
          self.bridge_below);
  }
};

using NodeViews = std::vector<std::shared_ptr<const ScanView>>;

/// How scans are compared to find loops.
struct LoopSearch {
  const MatchSearchOptions& matching;
  const LoopDetectionOptions& detection;
  Execution execution;
  MatchCache* store = nullptr;  ///< by the numbers of the nodes; may be null
};

/// Each node from `first` on, aligned to the earlier ones that look most alike. Stops with what was found by then when
/// the observer asks to.
std::vector<EdgeCandidate> likely_loops(const NodeViews& views, std::size_t first, const LoopSearch& search);

/// The few nodes before and after each of `links` (node i to node i + 1), all aligned to each other. Throws Interrupted
/// when the observer asks to stop.
std::vector<EdgeCandidate> cross_edge_matches(const NodeViews& views, const std::vector<std::size_t>& edges,
                                              const LoopSearch& search);

}  // namespace shapemap
