// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "shapemap/io/log_file.hpp"
#include "shapemap/io/log_selection.hpp"
#include "shapemap/mapper/map_log.hpp"

/// A trace holds all steps that led to a map, for figures and analyses; docs/formats.md describes its members.
namespace shapemap {

/// The run that is traced. The references must outlive the trace.
struct TracedRun {
  std::vector<std::string> log_paths;  ///< one for each session
  const Log& log;                      ///< the selected scans
  const MappingOptions& mapping;
  const LogReadOptions& reading;
  const SelectionOptions& selection;
};

class ByteSink;

/// Writes one JSON object a line as soon as there is something to tell, so that memory does not grow with the log. The
/// trace has no times and no number of threads: the same map has the same trace. All functions throw OutputError.
class TraceFile : public MappingEvents {
 public:
  /// The file is compressed when `path` ends in ".gz".
  TraceFile(const std::string& path, TracedRun run);
  ~TraceFile() override;

  void on_shape(std::size_t scan_index, const std::vector<ShapePoint>& points) override;
  void on_alignment(const TracedAlignment& alignment) override;
  void on_edge(const EdgeFound& edge) override;
  void on_edge_chosen(const EdgeChosen& choice) override;
  void on_edge_verified(const EdgeVerified& revision) override;

  /// Writes the result of each scan and moves the file to its place; without this call no file appears.
  void commit(const MapResult& result);

 private:
  TracedRun run_;
  std::unique_ptr<ByteSink> sink_;
};

}  // namespace shapemap
