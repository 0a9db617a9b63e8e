// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/matching/match_search.hpp"

namespace shapemap {

/// Whether two scans at a pose show the same so well that one can replace the other.
bool shows_the_same(const MatchCandidate& pose);

}  // namespace shapemap
