// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <mutex>
#include <tuple>

#include "shapemap/matching/match_cache.hpp"

namespace shapemap {

/// Keeps matches in memory, and passes them on to another cache where there is one.
class MemoryMatchCache : public MatchCache {
 public:
  /// `next` may be null.
  explicit MemoryMatchCache(MatchCache* next = nullptr) : next_(next) {}

  std::optional<std::vector<MatchCandidate>> find(const MatchKey& key) override;
  void keep(const MatchKey& key, const std::vector<MatchCandidate>& candidates) override;

 private:
  MatchCache* next_;
  std::mutex mutex_;
  std::map<std::tuple<std::size_t, std::size_t, SearchKind>, std::vector<MatchCandidate>> known_;
};

}  // namespace shapemap
