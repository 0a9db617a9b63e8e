// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/map_log.hpp"

#include <algorithm>
#include <chrono>

#include "methods.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/grid/scan_consistency.hpp"
#include "shapemap/mapper/mapper.hpp"
#include "shapemap/mapper/mirror_check.hpp"
#include "shapemap/scan/joined_logs.hpp"
#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

/// The first of the fragments with most positions.
int largest(const std::vector<Component>& components) {
  const auto fewer = [](const Component& a, const Component& b) { return a.scans.size() < b.scans.size(); };
  const auto found = std::max_element(components.begin(), components.end(), fewer);
  return found == components.end() ? -1 : static_cast<int>(found - components.begin());
}

/// Scans that are worked on together, and between which the observer is asked; part of no result.
constexpr std::size_t kBlock = 32;

MapResult map_robustly(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink,
                       MatchCache* store) {
  LiveOptions live;
  live.publish = false;
  Mapper mapper(options, live, &observer, sink, store);
  observer.on_stage("chain");
  std::size_t session = 0;
  for (const LogPart& part : parts_of(log)) {
    for (std::size_t first = part.first; first < part.last && observer.keep_going(); first += kBlock) {
      const std::size_t last = std::min(first + kBlock, part.last);
      mapper.add_scans(&log.scans[first], last - first, session);
      observer.on_progress(last, log.scans.size());
    }
    ++session;
  }
  return mapper.finish();
}

}  // namespace

MapResult map_log(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink,
                  MatchCache* store) {
  validate_all(options);
  require_plausible(log);
  MapResult result;
  try {
    if (options.run.method == Method::kPaper) {
      map_by_paper(log, options, observer, sink, result);
    } else {
      result = map_robustly(log, options, observer, sink, store);
    }
  } catch (const Interrupted&) {
    result.interrupted = true;
  }
  const auto start = std::chrono::steady_clock::now();
  judge_consistency(log, options.returns, options.consistency, result.components);
  result.times.consistency_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.largest_component = largest(result.components);
  if (const TurnComparison turns = compare_turns(log, result.placed()); turns.is_mirrored()) {
    observer.on_warning("the scans seem to be mirrored: of the turns that the log itself records, " +
                        std::to_string(turns.num_opposite) + " of " +
                        std::to_string(turns.num_alike + turns.num_opposite) + " go the other way; see --upside-down");
  }
  return result;
}

}  // namespace shapemap
