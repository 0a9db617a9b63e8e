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

/// The surroundings of a mapper's back end. `cache` may be null; a `publish` that is empty is not called.
struct BackEndContext {
  const MappingOptions& options;
  MappingEvents& events;
  MatchCache* cache = nullptr;
  /// Receives a map after each optimisation of the graph. Whether maps are published does not change the result.
  std::function<void(Map)> publish;
};

/// Adds the keyframes of the front end to the graph, and makes the map of it. When there are many keyframes, it closes
/// loops, and culls redundant keyframes. From then on it localizes the robot in that map, culls new keyframes at known
/// places, and optimises the whole graph again when it has many more keyframes.
///
/// The moments of this work depend on the scans alone, so that the result is reproducible.
class BackEnd {
 public:
  explicit BackEnd(BackEndContext context);

  void add(TrackedScan scan);

  /// Returns the map of all scans. When the observer asks to stop, nothing more is searched, and the map is made of
  /// what was found.
  MapResult finish();

 private:
  Execution execution() const { return {context_.options.run.threads, context_.events}; }
  /// While previews are made, their matches are kept for the next previews, and for the result.
  MatchCache* cache() { return preview_cache_ ? &*preview_cache_ : context_.cache; }
  LoopSearch loop_search(const Execution& execution);
  bool closes_loops() const { return context_.options.robust.loops.close_loops; }
  void update();
  void choose_odometry();
  void release_views();
  bool optimize_and_cull();
  void follow();
  void cull(const std::vector<std::optional<ReplacementKeyframe>>& redundant, OptimizedMap& map);
  void tell_localization();
  void publish(const KeyframeGraph& graph, const OptimizedMap& map) const;
  void preview();

  BackEndContext context_;
  MapResult result_;
  std::vector<std::size_t> num_sweeps_;  ///< number of sweeps of each scan
  KeyframeGraph graph_;
  LoopCandidates loops_;
  RevisitTracker revisits_;
  bool is_following_ = false;
  bool is_lost_ = false;
  std::size_t cull_at_;            ///< number of keyframes before any is culled
  std::size_t next_optimization_;  ///< number of keyframes at which the graph is optimised next
  std::size_t next_update_;        ///< number of keyframes at which the next update is due
  std::size_t next_preview_;       ///< number of keyframes of the next preview; none follows the first optimisation
  LoopCandidates preview_loops_;
  std::optional<MemoryMatchCache> preview_cache_;
};

}  // namespace shapemap
