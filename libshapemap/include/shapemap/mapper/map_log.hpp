// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/core/observer.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/mapper/trace_sink.hpp"
#include "shapemap/matching/match_cache.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// The main job: a pose for every position of `log` that can be aligned to the ones before it, from ranges alone.
/// A position that cannot be aligned starts a new fragment. Same input and options give the same bits for any
/// number of threads, with or without a `sink` that looks on. The robust method asks `store` for alignments, and gives
/// it those that it makes. Throws ConfigError for bad options, and InputError for a
/// position that no sensor can have recorded (scan/plausibility.hpp); never throws for scans that do not match.
MapResult map_log(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink = nullptr,
                  MatchCache* store = nullptr);

}  // namespace shapemap
