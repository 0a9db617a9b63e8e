// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/mapper/map_log.hpp"

#include <algorithm>
#include <chrono>

#include "methods.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/grid/scan_consistency.hpp"
#include "shapemap/mapper/mirror_check.hpp"
#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

/// The first of the fragments with most positions.
int largest(const std::vector<Fragment>& fragments) {
  const auto fewer = [](const Fragment& a, const Fragment& b) { return a.positions.size() < b.positions.size(); };
  const auto found = std::max_element(fragments.begin(), fragments.end(), fewer);
  return found == fragments.end() ? -1 : static_cast<int>(found - fragments.begin());
}

}  // namespace

const std::vector<PlacedPosition>& MapResult::placed() const {
  static const std::vector<PlacedPosition> none;
  return largest_fragment < 0 ? none : fragments[static_cast<std::size_t>(largest_fragment)].positions;
}

std::string MapResult::why_not_in_map(const PositionResult& position) const {
  if (position.fragment < 0) return position.reason;
  if (position.fragment == largest_fragment) return "";
  return position.reason + (position.reason.empty() ? "" : "; ") + "in fragment " + std::to_string(position.fragment) +
         ", which nothing ties to the map";
}

MapResult map_log(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink,
                  AlignmentStore* store) {
  validate_all(options);
  require_plausible(log);
  MapResult result;
  try {
    if (options.run.method == Method::kPaper) {
      chain_by_paper(log, options, observer, sink, result);
    } else {
      map_robustly(log, options, observer, sink, store, result);
    }
  } catch (const Interrupted&) {
    result.interrupted = true;
  }
  const auto start = std::chrono::steady_clock::now();
  judge_scans(log, options.returns, options.agreement, result.fragments);
  result.times.agreement_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.largest_fragment = largest(result.fragments);
  if (const TurnComparison turns = compare_turns(log, result.placed()); turns.is_mirrored()) {
    observer.on_warning("the scans seem to be mirrored: of the turns that the log itself records, " +
                        std::to_string(turns.num_opposite) + " of " +
                        std::to_string(turns.num_alike + turns.num_opposite) + " go the other way; see --upside-down");
  }
  return result;
}

}  // namespace shapemap
