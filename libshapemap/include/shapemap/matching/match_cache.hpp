// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "shapemap/matching/match_search.hpp"

/// How alignments outlive the run that made them. See io/alignment_store_file.hpp for a store in a file.
namespace shapemap {

enum class SearchKind {
  kFull,      ///< of a scan and the one before
  kBorrowed,  ///< of a scan and one further back: never all rotations
  kLoop,      ///< of many pairs, most of which have nothing in common: with little effort
};

/// Which alignment of a log; both are indices of its positions.
struct AlignmentKey {
  std::size_t reference = 0;
  std::size_t query = 0;
  SearchKind search = SearchKind::kFull;
};

/// Keeps what pose_hypotheses() found, to the last bit. Calls come from any thread, and several at a time; what a store
/// throws ends the run. That there is one, and what it knows, changes no result.
struct AlignmentStore {
  virtual ~AlignmentStore() = default;
  /// Nothing when the alignment is not known.
  virtual std::optional<std::vector<PoseHypothesis>> find(const AlignmentKey& key) = 0;
  virtual void keep(const AlignmentKey& key, const std::vector<PoseHypothesis>& hypotheses) = 0;
};

/// pose_hypotheses(), unless `store` has them; they are kept there otherwise. `options` are those of the kind of search
/// that `key` says. `store` may be null.
std::vector<PoseHypothesis> pose_hypotheses(const ScanView& reference, const ScanView& query,
                                            const HypothesisSearchOptions& options, const AlignmentKey& key,
                                            AlignmentStore* store);

}  // namespace shapemap
