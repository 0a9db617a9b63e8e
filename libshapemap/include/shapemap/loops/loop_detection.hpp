// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "shapemap/core/execution.hpp"
#include "shapemap/core/options.hpp"
#include "shapemap/loops/loop_clusters.hpp"
#include "shapemap/matching/match_cache.hpp"

/// These functions find loop candidates.
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

/// These are the settings with which scans are matched to find loops.
struct LoopSearch {
  const MatchSearchOptions& matching;
  const LoopDetectionOptions& detection;
  Execution execution;
  MatchCache* store = nullptr;  ///< its keys have the indices of nodes; may be null
};

/// Matches each node from `first` on to the earlier nodes with the most similar place descriptors, and returns the
/// candidates. When the observer asks to stop, it returns those found by then.
std::vector<EdgeCandidate> likely_loops(const NodeViews& views, std::size_t first, const LoopSearch& search);

/// Matches the few nodes before each of `edges` (from node i to node i + 1) to the few nodes after it, and returns the
/// candidates. Throws Interrupted when the observer asks to stop.
std::vector<EdgeCandidate> cross_edge_matches(const NodeViews& views, const std::vector<std::size_t>& edges,
                                              const LoopSearch& search);

}  // namespace shapemap
