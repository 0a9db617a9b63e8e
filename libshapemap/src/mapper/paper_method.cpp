// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "paper_method.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/paper/paper_mapper.hpp"

namespace shapemap {
namespace {

/// Returns false when the observer asked to stop; the mapper then has a map of the scans until then.
bool push_scans(const Log& log, RunObserver& observer, PaperMapper& mapper) {
  try {
    for (const Scan& scan : log.scans) {
      if (!observer.keep_going()) return false;
      const PaperScanResult& added = mapper.add_scan(scan);
      observer.on_progress(added.scan_index + 1, log.scans.size());
    }
  } catch (const Interrupted&) {
    return false;
  }
  return true;
}

void add_times(const PaperAlignment& alignment, StageTimes& times) {
  times.align_s += alignment.match_s;
  times.icp_s += alignment.icp_s;
  times.decoupled_icp_s += alignment.decoupled_icp_s;
}

ScanResult scan_result(PaperScanResult placed) {
  ScanResult scan;
  scan.scan_index = placed.scan_index;
  scan.timestamp_s = placed.timestamp_s;
  scan.component = placed.component;
  scan.starts_component = placed.starts_component;
  scan.reason = placed.reason();
  scan.paper = std::move(placed.alignment);
  return scan;
}

}  // namespace

void map_by_paper(const Log& log, const MappingOptions& options, MappingEvents& events, MapResult& result) {
  PaperMapper mapper({options.returns, options.polylines, options.shape, options.paper}, {options.run.threads, events},
                     &events);
  events.on_stage("chain");
  const bool is_whole = push_scans(log, events, mapper);
  PaperMapResult placed = std::move(mapper).result();
  result.components = std::move(placed.components);
  result.times.shape_s += placed.shape_s;
  for (PaperScanResult& scan : placed.scans) {
    if (scan.alignment) add_times(*scan.alignment, result.times);
    result.scans.push_back(scan_result(std::move(scan)));
  }
  if (!is_whole) throw Interrupted();
}

}  // namespace shapemap
