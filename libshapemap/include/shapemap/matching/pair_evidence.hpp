// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/matching/match_search.hpp"

namespace shapemap {

/// Whether two scans at a pose show the same so well that one can replace the other.
bool can_stand_for(const PoseHypothesis& pose);

}  // namespace shapemap
