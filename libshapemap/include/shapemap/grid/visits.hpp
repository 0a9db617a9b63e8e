// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/scan/placed_scan.hpp"

namespace shapemap {

/// Scans that follow each other from nearly the same place make one visit: they see the same and err alike, so that
/// they are no evidence for each other. Returns the index of the first scan of each visit and, at the end, the number
/// of scans.
std::vector<std::size_t> starts_of_visits(const std::vector<PlacedScan>& placed);

}  // namespace shapemap
