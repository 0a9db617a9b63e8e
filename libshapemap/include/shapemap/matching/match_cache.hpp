// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "shapemap/matching/match_search.hpp"

/// How alignments outlive the run that made them. See io/alignment_store_file.hpp for a store in a file.
namespace shapemap {

enum class SearchKind {
  kFull,            ///< of a scan and the one before
  kMultiReference,  ///< of a scan and one further back: never all rotations
  kLoop,            ///< of many pairs, most of which have nothing in common: with little effort
};

/// Which alignment of a log; both are indices of its positions.
struct MatchKey {
  std::size_t reference = 0;
  std::size_t query = 0;
  SearchKind search = SearchKind::kFull;
};

/// Keeps what find_candidates() found, to the last bit. Calls come from any thread, and several at a time; what a store
/// throws ends the run. That there is one, and what it knows, changes no result.
struct MatchCache {
  virtual ~MatchCache() = default;
  /// Nothing when the alignment is not known.
  virtual std::optional<std::vector<MatchCandidate>> find(const MatchKey& key) = 0;
  virtual void keep(const MatchKey& key, const std::vector<MatchCandidate>& candidates) = 0;
};

/// find_candidates(), unless `store` has them; they are kept there otherwise. `options` are those of the kind of search
/// that `key` says. `store` may be null.
std::vector<MatchCandidate> find_candidates(const ScanView& reference, const ScanView& query,
                                            const MatchSearchOptions& options, const MatchKey& key, MatchCache* store);

}  // namespace shapemap
