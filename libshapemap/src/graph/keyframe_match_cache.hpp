// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "keyframe_graph.hpp"
#include "shapemap/matching/match_cache.hpp"

namespace shapemap {

/// Knows the alignments of keyframes as those of their positions.
class KeyframeMatchCache : public MatchCache {
 public:
  KeyframeMatchCache(const KeyframeGraph& chain, MatchCache& of_positions)
      : chain_(chain), of_positions_(of_positions) {}

  std::optional<std::vector<MatchCandidate>> find(const MatchKey& key) override {
    return of_positions_.find(of_position(key));
  }
  void keep(const MatchKey& key, const std::vector<MatchCandidate>& candidates) override {
    of_positions_.keep(of_position(key), candidates);
  }

 private:
  MatchKey of_position(const MatchKey& key) const {
    return {chain_.keyframes[key.reference].scan_index, chain_.keyframes[key.query].scan_index, key.search};
  }

  const KeyframeGraph& chain_;
  MatchCache& of_positions_;
};

}  // namespace shapemap
