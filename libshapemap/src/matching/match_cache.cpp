// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/match_cache.hpp"

#include <utility>

namespace shapemap {

std::vector<MatchCandidate> find_candidates(const ScanView& reference, const ScanView& query,
                                            const MatchSearchOptions& options, const MatchKey& key, MatchCache* cache) {
  if (cache) {
    if (std::optional<std::vector<MatchCandidate>> known = cache->find(key)) return std::move(*known);
  }
  std::vector<MatchCandidate> found = find_candidates(reference, query, options);
  if (cache) cache->keep(key, found);
  return found;
}

}  // namespace shapemap
