// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// A motion gives the pose of the robot when a beam was sent, in the robot's frame at the stamp.
using BeamMotion = std::function<Pose2(std::size_t beam)>;

/// Returns `sweep` as if all of its beams had been sent at the stamp. Beams are sorted by their new directions; those
/// that see again where the sweep had already been are left out. A beam without a return is only turned.
Sweep unbent(const Sweep& sweep, const ReturnOptions& options, const BeamMotion& stamp_from_beam);

/// Returns how far a point moves at most when `sweep` is unbent.
double most_bent_m(const Sweep& sweep, const ReturnOptions& options, const BeamMotion& stamp_from_beam);

}  // namespace shapemap
