// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "keyframe_graph.hpp"
#include "shapemap/matching/match_cache.hpp"

namespace shapemap {

/// Knows the alignments of keyframes as those of their positions.
class KeyframeStore : public AlignmentStore {
 public:
  KeyframeStore(const KeyframeChain& chain, AlignmentStore& of_positions)
      : chain_(chain), of_positions_(of_positions) {}

  std::optional<std::vector<PoseHypothesis>> find(const AlignmentKey& key) override {
    return of_positions_.find(of_position(key));
  }
  void keep(const AlignmentKey& key, const std::vector<PoseHypothesis>& hypotheses) override {
    of_positions_.keep(of_position(key), hypotheses);
  }

 private:
  AlignmentKey of_position(const AlignmentKey& key) const {
    return {chain_.keyframes[key.reference].position_index, chain_.keyframes[key.query].position_index, key.search};
  }

  const KeyframeChain& chain_;
  AlignmentStore& of_positions_;
};

}  // namespace shapemap
