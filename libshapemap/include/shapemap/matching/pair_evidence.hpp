// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/matching/match_search.hpp"

namespace shapemap {

/// Returns whether two scans at this pose show the same surfaces so well that one can replace the other.
bool shows_the_same(const MatchCandidate& pose);

}  // namespace shapemap
