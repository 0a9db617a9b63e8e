// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

#include "shapemap/core/pose2.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// Where the robot was when a beam was sent, as seen from where it was at the stamp.
using BeamMotion = std::function<Pose2(std::size_t beam)>;

/// `sweep` as if all of its beams had been sent at the stamp. Beams are sorted by their new directions; those that
/// look again where the sweep had already been are left out. A beam without return is turned only.
Sweep unbent(const Sweep& sweep, const ReturnOptions& options, const BeamMotion& stamp_from_beam);

/// How far a hit moves at most when `sweep` is unbent.
double most_bent_m(const Sweep& sweep, const ReturnOptions& options, const BeamMotion& stamp_from_beam);

}  // namespace shapemap
