// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/memory_match_cache.hpp"

#include <utility>

namespace shapemap {

std::optional<std::vector<MatchCandidate>> MemoryMatchCache::find(const MatchKey& key) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = known_.find({key.reference, key.query, key.search});
    if (known != known_.end()) return known->second;
  }
  return next_ ? next_->find(key) : std::nullopt;
}

void MemoryMatchCache::keep(const MatchKey& key, const std::vector<MatchCandidate>& candidates) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    known_[{key.reference, key.query, key.search}] = candidates;
  }
  if (next_) next_->keep(key, candidates);
}

}  // namespace shapemap
