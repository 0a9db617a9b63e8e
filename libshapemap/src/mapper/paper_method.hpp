// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/mapper/mapping_events.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// Pushes all scans of a log into a PaperMapper, and fills in the scans, components and times of `result`. Throws
/// Interrupted when the events ask to stop; `result` then is the map of the scans until then.
void map_by_paper(const Log& log, const MappingOptions& options, MappingEvents& events, MapResult& result);

}  // namespace shapemap
