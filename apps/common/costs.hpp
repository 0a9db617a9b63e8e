// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/core/stopwatch.hpp"

namespace shapemap::cli {

/// Returns the user and system time of all threads of this process since its start.
double cpu_seconds();
double peak_memory_mib();

}  // namespace shapemap::cli
