// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/mapper/mapping_events.hpp"
#include "shapemap/matching/match_cache.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// Makes a map of a whole log: it finds a pose for every scan of `log` that can be matched to those before it, from
/// ranges alone. All scans are pushed into a Mapper, or a PaperMapper, in their order; then the consistency of each
/// with the map is judged. The result names the scans that cannot be placed, and why. The same input and options give
/// the same bits for any number of threads, and any listener. When `events` ask to stop, the result is the map of the
/// scans until then. The robust method asks `cache` for matches, and gives it those that it makes; it may be null.
/// Throws ConfigError for bad options, and InputError for a scan that no sensor can have recorded
/// (scan/plausibility.hpp); never throws for scans that do not match.
MapResult map_log(const Log& log, const MappingOptions& options, MappingEvents& events, MatchCache* cache = nullptr);

}  // namespace shapemap
