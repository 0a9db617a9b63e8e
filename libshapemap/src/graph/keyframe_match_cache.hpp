// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "keyframe_graph.hpp"
#include "shapemap/matching/match_cache.hpp"

namespace shapemap {

/// Keeps the matches of keyframes under the numbers of their scans, which do not change when keyframes are culled.
class KeyframeMatchCache : public MatchCache {
 public:
  KeyframeMatchCache(const KeyframeGraph& graph, MatchCache& of_scans) : graph_(graph), of_scans_(of_scans) {}

  std::optional<std::vector<MatchCandidate>> find(const MatchKey& key) override { return of_scans_.find(of_scan(key)); }
  void keep(const MatchKey& key, const std::vector<MatchCandidate>& candidates) override {
    of_scans_.keep(of_scan(key), candidates);
  }

 private:
  MatchKey of_scan(const MatchKey& key) const {
    return {graph_.keyframes[key.reference].scan_index, graph_.keyframes[key.query].scan_index, key.search};
  }

  const KeyframeGraph& graph_;
  MatchCache& of_scans_;
};

}  // namespace shapemap
