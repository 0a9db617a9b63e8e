// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/trace_file.hpp"

#include <utility>

#include "byte_sink.hpp"
#include "trace_json.hpp"

namespace shapemap {
namespace {

bool ends_in_gz(const std::string& path) { return path.size() > 3 && path.compare(path.size() - 3, 3, ".gz") == 0; }

void write_line(const Json& record, ByteSink& sink) {
  // Names in a log may hold any bytes; those that are no UTF-8 are replaced rather than fatal.
  sink.write(record.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace

TraceFile::TraceFile(const std::string& path, TracedRun run)
    : run_(std::move(run)),
      sink_(std::make_unique<ByteSink>(
          path, ends_in_gz(path) ? ByteSink::Compression::kGzip : ByteSink::Compression::kNone)) {
  write_line(run_json(run_), *sink_);
}

TraceFile::~TraceFile() = default;

void TraceFile::on_shape(std::size_t scan_index, const std::vector<ShapePoint>& points) {
  write_line(scan_json(run_, scan_index, points), *sink_);
}

void TraceFile::on_alignment(const TracedAlignment& alignment) {
  write_line(alignment_json(alignment, run_.mapping.paper.lcs.target), *sink_);
}

void TraceFile::on_edge(const EdgeFound& edge) { write_line(edge_json(edge), *sink_); }

void TraceFile::on_edge_chosen(const EdgeChosen& choice) { write_line(choice_json(choice), *sink_); }

void TraceFile::on_edge_verified(const EdgeVerified& revision) { write_line(revision_json(revision), *sink_); }

void TraceFile::commit(const MapResult& result) {
  // Scans and components are both in the order of the log, so that counting finds the entry of each scan.
  std::vector<std::size_t> next_of_component(result.components.size(), 0);
  for (const ScanResult& scan : result.scans) {
    const PlacedScan* placed = nullptr;
    if (scan.component >= 0) {
      const auto component = static_cast<std::size_t>(scan.component);
      placed = &result.components.at(component).scans.at(next_of_component[component]++);
    }
    write_line(result_json(scan, placed), *sink_);
  }
  write_line(end_json(result), *sink_);
  sink_->commit();
}

}  // namespace shapemap
