// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/shape/scan_view.hpp"

namespace shapemap {

/// Rotations under which surfaces of the two scans run the same way: peaks of the circular correlation of their
/// tangent histograms, best first, at most `max_count`.
std::vector<double> rotation_hypotheses(const TangentHistogram& reference, const TangentHistogram& query,
                                        int max_count);

}  // namespace shapemap
