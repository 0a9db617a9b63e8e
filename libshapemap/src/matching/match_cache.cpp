// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/match_cache.hpp"

#include <utility>

namespace shapemap {

std::vector<MatchCandidate> find_candidates(const ScanView& reference, const ScanView& query,
                                            const MatchSearchOptions& options, const MatchKey& key, MatchCache* store) {
  if (store) {
    if (std::optional<std::vector<MatchCandidate>> known = store->find(key)) return std::move(*known);
  }
  std::vector<MatchCandidate> found = find_candidates(reference, query, options);
  if (store) store->keep(key, found);
  return found;
}

}  // namespace shapemap
