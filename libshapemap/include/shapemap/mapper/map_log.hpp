// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/mapper/mapping_events.hpp"
#include "shapemap/matching/match_cache.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// The main job: a pose for every scan of `log` that can be matched to those before it, from ranges alone. All scans
/// are pushed into a Mapper, or a PaperMapper, in their order; then the consistency of each with the map is judged. A
/// scan that cannot be placed is told in the result. Same input and options give the same bits for any number of
/// threads, whoever listens. When `events` ask to stop, what has come by then is made a map. The robust method asks
/// `cache` for matches, and gives it those that it makes; it may be null. Throws ConfigError for bad options, and
/// InputError for a scan that no sensor can have recorded (scan/plausibility.hpp); never throws for scans that do not
/// match.
MapResult map_log(const Log& log, const MappingOptions& options, MappingEvents& events, MatchCache* cache = nullptr);

}  // namespace shapemap
