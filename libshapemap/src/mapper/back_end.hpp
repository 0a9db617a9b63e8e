// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "front_end.hpp"
#include "graph/keyframe_graph.hpp"
#include "inference/optimized_map.hpp"
#include "localization/revisit_tracking.hpp"
#include "loops/loop_candidates.hpp"
#include "shapemap/mapper/map.hpp"
#include "shapemap/mapper/map_result.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/mapper/mapping_events.hpp"
#include "shapemap/matching/memory_match_cache.hpp"

namespace shapemap {

/// What the back end of a mapper works with. `cache` may be null; a `publish` that is empty is not called.
struct BackEndContext {
  const MappingOptions& options;
  MappingEvents& events;
  MatchCache* cache = nullptr;
  /// Receives a map whenever the graph was solved. Maps that are only published change nothing of the result.
  std::function<void(Map)> publish;
};

/// Grows the graph of keyframes by what the front end has tracked, and makes the map of it. When there are many
/// keyframes, it closes loops, and culls those that the map has twice. From then on it follows the robot in that map,
/// culls keyframes at places that are known again soon, and solves for all of it again when there are many more.
///
/// When it does so depends on the scans that came, and on nothing else.
class BackEnd {
 public:
  explicit BackEnd(BackEndContext context);

  void add(TrackedScan scan);

  /// All of the map, from all that came. What is found out when the observer asks to stop is used; no more is then
  /// looked for.
  MapResult finish();

 private:
  Execution execution() const { return {context_.options.run.threads, context_.events}; }
  /// While previews are made, what they match is kept for those to come, and for the result.
  MatchCache* cache() { return preview_cache_ ? &*preview_cache_ : context_.cache; }
  LoopSearch loop_search(const Execution& execution);
  bool closes_loops() const { return context_.options.robust.loops.close_loops; }
  void update();
  void choose_odometry();
  void let_views_go();
  bool optimize_and_cull();
  void follow();
  void cull(const std::vector<std::optional<ReplacementKeyframe>>& redundant, OptimizedMap& map);
  void tell_localization();
  void publish(const KeyframeGraph& graph, const OptimizedMap& map) const;
  void preview();

  BackEndContext context_;
  MapResult result_;
  std::vector<std::size_t> num_sweeps_;  ///< of each scan
  KeyframeGraph graph_;
  LoopCandidates loops_;
  RevisitTracker revisits_;
  bool is_following_ = false;
  bool is_lost_ = false;
  std::size_t cull_at_;            ///< so many keyframes are needed before any is culled
  std::size_t next_optimization_;  ///< so many keyframes make the graph be solved
  std::size_t next_update_;        ///< so many keyframes make it be looked at
  std::size_t next_preview_;       ///< so many keyframes make a map be published while none was solved for
  LoopCandidates preview_loops_;
  std::optional<MemoryMatchCache> preview_cache_;
};

}  // namespace shapemap
