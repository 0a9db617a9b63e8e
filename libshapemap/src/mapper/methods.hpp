// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "shapemap/core/observer.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/mapper/trace_sink.hpp"
#include "shapemap/matching/match_cache.hpp"
#include "shapemap/scan/scan.hpp"

/// The two ways to map a log. Each fills in positions, fragments and times, and throws Interrupted when the observer
/// asks to stop; what is in `result` then is whole. `listener`, `sink` and `store` may be null.
namespace shapemap {

/// The paper's: each scan is pushed into a PaperMapper.
void map_by_paper(const Log& log, const MappingOptions& options, RunObserver& observer, PaperListener* listener,
                  MapResult& result);

}  // namespace shapemap
