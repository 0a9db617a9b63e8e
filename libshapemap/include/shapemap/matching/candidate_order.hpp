// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/matching/match_search.hpp"

namespace shapemap {

/// Orders candidates from the best to the worst.
inline bool is_more_likely(const MatchCandidate& a, const MatchCandidate& b) { return a.score > b.score; }

}  // namespace shapemap
