// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/mapper/map_result.hpp"

namespace shapemap {

/// Returns, for each scan, the index of the scan that it is matched with.
std::vector<std::size_t> references_of(const MapResult& result);

}  // namespace shapemap
