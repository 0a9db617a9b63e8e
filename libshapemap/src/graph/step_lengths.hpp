// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/graph/loop_closing.hpp"

namespace shapemap {

/// Nineteen of twenty sure steps of the chain are shorter.
double usual_step_m(const std::vector<ChainLink>& links);

}  // namespace shapemap
