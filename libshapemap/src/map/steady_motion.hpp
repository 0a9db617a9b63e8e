// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/map/trajectory.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// Scans that keyframes stand for are placed one by one, and along a bare corridor that says little. Where scans follow
/// each other closely, each of them is drawn towards the middle between the one before and the one after, by as much as
/// its covariance allows. Not by time: recorded times are often not those of the scans. `placed` is in the order of the
/// log; `outcomes` has an entry for each position of the log.
void steady_motion(const Log& log, const std::vector<PositionResult>& outcomes, std::vector<PlacedPosition>& placed);

}  // namespace shapemap
