// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "shapemap/matching/match_search.hpp"

/// A cache lets matches outlive the run that made them. See io/match_cache_file.hpp for a cache in a file.
namespace shapemap {

enum class SearchKind {
  kFull,            ///< a scan is matched to the keyframe before it
  kMultiReference,  ///< a scan is matched to a keyframe further back, without the search over all rotations
  kLoop,            ///< many pairs are searched for loops with little effort, as most have nothing in common
};

/// Identifies a match of a log; both numbers are indices of its scans.
struct MatchKey {
  std::size_t reference = 0;
  std::size_t query = 0;
  SearchKind search = SearchKind::kFull;
};

/// Keeps what find_candidates() found, to the last bit. Calls come from any thread, and several at a time; an exception
/// of a cache ends the run. Neither the presence of a cache nor its content changes a result.
struct MatchCache {
  virtual ~MatchCache() = default;
  /// Returns nothing when the match is not known.
  virtual std::optional<std::vector<MatchCandidate>> find(const MatchKey& key) = 0;
  virtual void keep(const MatchKey& key, const std::vector<MatchCandidate>& candidates) = 0;
};

/// Returns what `cache` has for `key`, or else calls find_candidates() and keeps the result there. `options` must
/// belong to the kind of search of `key`. `cache` may be null.
std::vector<MatchCandidate> find_candidates(const ScanView& reference, const ScanView& query,
                                            const MatchSearchOptions& options, const MatchKey& key, MatchCache* cache);

}  // namespace shapemap
