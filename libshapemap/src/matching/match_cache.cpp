// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/match_cache.hpp"

#include <utility>

namespace shapemap {

std::vector<PoseHypothesis> pose_hypotheses(const ScanView& reference, const ScanView& query,
                                            const HypothesisSearchOptions& options, const AlignmentKey& key,
                                            AlignmentStore* store) {
  if (store) {
    if (std::optional<std::vector<PoseHypothesis>> known = store->find(key)) return std::move(*known);
  }
  std::vector<PoseHypothesis> found = pose_hypotheses(reference, query, options);
  if (store) store->keep(key, found);
  return found;
}

}  // namespace shapemap
