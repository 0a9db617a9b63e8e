// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/map/trajectory.hpp"

namespace shapemap {

inline constexpr std::size_t kNoReference = static_cast<std::size_t>(-1);

/// For each position: that which its alignment is to, the keyframe before it.
std::vector<std::size_t> references_of(const MapResult& result);

}  // namespace shapemap
