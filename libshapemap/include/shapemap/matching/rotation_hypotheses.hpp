// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/shape/scan_view.hpp"

namespace shapemap {

/// Returns at most `max_count` rotations [rad] that make the surfaces of the two scans parallel, best first: they are
/// the peaks of the circular correlation of the tangent histograms.
std::vector<double> rotation_hypotheses(const TangentHistogram& reference, const TangentHistogram& query,
                                        int max_count);

}  // namespace shapemap
