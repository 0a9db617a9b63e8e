// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "json_parts.hpp"
#include "shapemap/io/trace_file.hpp"

/// These functions make the records of a trace.
namespace shapemap {

Json run_json(const TracedRun& run);

/// `points` are those that the method uses. Polylines and histograms are computed once more, in the same way.
Json scan_json(const TracedRun& run, std::size_t scan_index, const std::vector<ShapePoint>& points);

Json alignment_json(const TracedAlignment& traced, LcsTarget target);
Json edge_json(const EdgeFound& edge);
Json choice_json(const EdgeChosen& choice);
Json revision_json(const EdgeVerified& revision);

/// `placed` is null for a scan that is in no component.
Json result_json(const ScanResult& scan, const PlacedScan* placed);

Json end_json(const MapResult& result);

}  // namespace shapemap
