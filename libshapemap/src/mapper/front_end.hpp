// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "scan_tracker.hpp"
#include "shapemap/core/observer.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/mapper/trace_sink.hpp"
#include "shapemap/matching/match_cache.hpp"
#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// Each scan against the keyframe before it, with several hypotheses, of which the scans further back decide. Adds an
/// entry for each position to `result`, without a place. `sink` and `store` may be null.
class FrontEnd {
 public:
  FrontEnd(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink, MatchCache* store,
           MapResult& result);

  /// Goes on until there are `most_keyframes`, and some more. False when the log is at its end, or the observer asks to
  /// stop: then what there is is whole.
  bool extend(std::size_t most_keyframes);

  /// Keyframes may be taken out of it between two calls of extend(), but for the last few.
  KeyframeGraph& graph() { return graph_; }

 private:
  double timed_for(std::size_t count, const std::function<void(std::size_t)>& work) const;
  void view_scans(std::size_t first, std::size_t last);
  Keyframe viewed(std::size_t scan_index) const;
  void take(Keyframe scan);
  void link_keyframes(std::size_t first_new);
  void expect(const ExpectedPose& expected, std::size_t edge);
  void expect_the_usual();
  void expect_the_usual(const MotionPrior& prior, std::size_t edge);
  std::vector<MatchCandidate> aligned(std::size_t reference, std::size_t query, SearchKind search,
                                      const MatchSearchOptions& options) const;
  std::vector<MatchCandidate> multi_reference_candidates(std::size_t edge) const;
  bool in_doubt(const std::vector<MatchCandidate>& edge) const;
  std::vector<std::vector<double>> three_scan_scores(std::size_t edge) const;
  void let_views_go();

  bool starts_session(std::size_t edge) const;
  std::vector<MatchCandidate>& candidates(std::size_t edge) { return graph_.edges[edge].candidates; }
  const std::vector<MatchCandidate>& candidates(std::size_t edge) const { return graph_.edges[edge].candidates; }
  const ScanView& view_of_keyframe(std::size_t i) const { return *graph_.keyframes[i].view; }
  std::size_t scan_of_keyframe(std::size_t keyframe) const { return graph_.keyframes[keyframe].scan_index; }

  const Log& log_;
  const MappingOptions& options_;
  RunObserver& observer_;
  TraceSink* sink_;
  MatchCache* store_;
  MapResult& result_;
  ScanTracker tracker_;
  std::size_t next_ = 0;       ///< the first position that was not looked at
  std::size_t last_seen_ = 0;  ///< the last position with shape
  KeyframeGraph graph_;
};

}  // namespace shapemap
