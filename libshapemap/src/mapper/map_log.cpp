// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/map_log.hpp"

#include <algorithm>

#include "paper_method.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/core/stopwatch.hpp"
#include "shapemap/grid/scan_consistency.hpp"
#include "shapemap/mapper/mapper.hpp"
#include "shapemap/mapper/mirror_check.hpp"
#include "shapemap/scan/joined_logs.hpp"
#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

/// Number of scans per call of the mapper, after which the observer is asked. It changes no result.
constexpr std::size_t kBlock = 32;

MapResult map_robustly(const Log& log, const MappingOptions& options, MappingEvents& events, MatchCache* cache) {
  LiveOptions live;
  live.publish = false;
  Mapper mapper(options, live, &events, cache);
  events.on_stage("chain");
  std::size_t session = 0;
  for (const LogPart& part : parts_of(log)) {
    for (std::size_t first = part.first; first < part.last && events.keep_going(); first += kBlock) {
      const std::size_t last = std::min(first + kBlock, part.last);
      mapper.add_scans(&log.scans[first], last - first, session);
      events.on_progress(last, log.scans.size());
    }
    ++session;
  }
  return mapper.finish();
}

}  // namespace

MapResult map_log(const Log& log, const MappingOptions& options, MappingEvents& events, MatchCache* cache) {
  validate_all(options);
  require_plausible(log);
  MapResult result;
  try {
    if (options.run.method == Method::kPaper) {
      map_by_paper(log, options, events, result);
    } else {
      result = map_robustly(log, options, events, cache);
    }
  } catch (const Interrupted&) {
    result.interrupted = true;
  }
  const Stopwatch watch;
  judge_consistency(log.scans, options.returns, options.consistency, result.components);
  result.times.consistency_s = watch.seconds();
  result.largest_component = largest_component(result.components);
  if (const TurnComparison turns = compare_turns(log.scans, sessions_of(log), result.placed()); turns.is_mirrored()) {
    events.on_warning("the scans seem to be mirrored: of the turns that the log itself records, " +
                      std::to_string(turns.num_opposite) + " of " +
                      std::to_string(turns.num_alike + turns.num_opposite) + " go the other way; see --upside-down");
  }
  return result;
}

}  // namespace shapemap
