// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "shapemap/core/observer.hpp"
#include "shapemap/graph/closed_loop.hpp"
#include "shapemap/graph/edge_support.hpp"
#include "shapemap/mapper/map.hpp"
#include "shapemap/mapper/scan_update.hpp"
#include "shapemap/matching/match_search.hpp"
#include "shapemap/paper/paper_listener.hpp"

/// The one stream of what happens while a map is made: progress bars, trace files, viewers and analyses listen to it.
/// Scans are told by their numbers, in the order in which they came.
namespace shapemap {

/// The candidates of an odometry edge, from which the whole log chooses.
struct EdgeFound {
  std::size_t reference_index = 0;
  std::size_t query_index = 0;
  const std::vector<MatchCandidate>& candidates;
  std::size_t num_own = 0;  ///< so many, the first, are the best first; keyframes further back have lent the rest
  double insufficient_view = 0.0;  ///< insufficient_view() of the two scans; 0 where a motion was expected
};

/// The candidate that an edge took in the end.
struct EdgeChosen {
  std::size_t reference_index = 0;
  std::size_t query_index = 0;
  std::size_t candidate = 0;  ///< index into the candidates that were found, or verified where they were
  double margin = 0.0;        ///< by how much it is better than the best other place
};

/// How an edge that was in doubt was judged by all scans of both sides; see verify_edges().
struct EdgeVerified {
  std::size_t reference_index = 0;
  std::size_t query_index = 0;
  const std::vector<MatchCandidate>& candidates;      ///< those that were found, and then what was looked for since
  const std::vector<EdgeSupport>& support_by_others;  ///< of each candidate
  const std::vector<double>& parallel_support;        ///< of each candidate
  std::size_t in_map = 0;                             ///< the candidate that the map had until then
  std::size_t candidate = 0;                          ///< the best
  double probability = 0.0;                           ///< that the best is right
};

/// A loop that was closed, or not.
struct LoopJudged {
  ClosedLoop loop;
  bool is_accepted = false;
  std::string why_not;  ///< one line; empty where it is accepted
};

/// Keyframes that others replace from now on.
struct KeyframesCulled {
  std::vector<std::size_t> scans;
  std::size_t num_left = 0;
};

/// Whether the robot knows its place in the part of the map that was solved.
struct RobotLocalized {
  std::size_t scan = 0;  ///< the last keyframe that was looked at
  bool is_lost = false;
};

/// All functions do nothing unless they are overridden. A listener changes no result but by keep_going(); what it
/// throws ends the call of the mapper that it listens to, and what the events refer to is gone afterwards. No two calls
/// come at a time. All come from the thread that calls the mapper; with LiveOptions::in_background, those from
/// on_edge() on come from another thread, and on_stage(), on_progress() and keep_going() belong to Mapper::finish()
/// alone.
///
/// From RunObserver come stages, progress and warnings, and the question whether to go on; from PaperListener the shape
/// of each scan, and the alignments of the paper's method.
struct MappingEvents : RunObserver, PaperListener {
  /// A scan has come, and has a place by its match.
  virtual void on_scan(const ScanUpdate& /*scan*/) {}
  /// An edge has all candidates that are looked for before the whole map is known.
  virtual void on_edge(const EdgeFound& /*edge*/) {}
  /// Of each solution of the graph, all loops that were considered.
  virtual void on_loop(const LoopJudged& /*loop*/) {}
  virtual void on_culled(const KeyframesCulled& /*culled*/) {}
  /// Told when it changes.
  virtual void on_localization(const RobotLocalized& /*localized*/) {}
  /// A map was published.
  virtual void on_map(const Map& /*map*/) {}
  /// In order, at the end.
  virtual void on_edge_verified(const EdgeVerified& /*edge*/) {}
  /// An edge has its verdict: at the end, or when one of its keyframes is culled.
  virtual void on_edge_chosen(const EdgeChosen& /*edge*/) {}
};

/// Tells each event to several listeners, in their order. It goes on while all of them want to.
class EventFanOut : public MappingEvents {
 public:
  /// Keeps the pointers, of which none is null.
  explicit EventFanOut(std::vector<MappingEvents*> listeners) : listeners_(std::move(listeners)) {}

  void on_stage(std::string_view stage) override;
  void on_progress(std::size_t done, std::size_t total) override;
  void on_warning(std::string_view message) override;
  bool keep_going() override;
  void on_shape(std::size_t scan_index, const std::vector<ShapePoint>& points) override;
  void on_alignment(const TracedAlignment& alignment) override;
  void on_scan(const ScanUpdate& scan) override;
  void on_edge(const EdgeFound& edge) override;
  void on_loop(const LoopJudged& loop) override;
  void on_culled(const KeyframesCulled& culled) override;
  void on_localization(const RobotLocalized& localized) override;
  void on_map(const Map& map) override;
  void on_edge_verified(const EdgeVerified& edge) override;
  void on_edge_chosen(const EdgeChosen& edge) override;

 private:
  std::vector<MappingEvents*> listeners_;
};

}  // namespace shapemap
