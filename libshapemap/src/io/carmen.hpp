// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>

#include "shapemap/core/angles.hpp"

namespace shapemap {

/// FLASER lines name no angles: by convention they start to the right and turn by a step that the number of beams
/// tells.
inline constexpr double kFlaserFirstAngle_rad = -90 * kDegree;
std::optional<double> flaser_step_rad(std::size_t num_beams);

}  // namespace shapemap
