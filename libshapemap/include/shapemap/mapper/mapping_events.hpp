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

/// One stream of events tells what happens while a map is made: progress bars, trace files, viewers and analyses listen
/// to it. Events name scans by their numbers, in the order in which they were pushed.
namespace shapemap {

/// The candidates of an odometry edge, of which the whole log chooses one.
struct EdgeFound {
  std::size_t reference_index = 0;
  std::size_t query_index = 0;
  const std::vector<MatchCandidate>& candidates;
  std::size_t num_own = 0;  ///< number of candidates of these two scans, which come first; the rest is multi-reference
  double insufficient_view = 0.0;  ///< insufficient_view() of the two scans; 0 where the motion was followed
};

/// The candidate that was finally chosen for an edge.
struct EdgeChosen {
  std::size_t reference_index = 0;
  std::size_t query_index = 0;
  std::size_t candidate = 0;  ///< index into the candidates of EdgeVerified where there is one, else of EdgeFound
  double margin = 0.0;        ///< its score minus that of the best other place
};

/// The verification of a doubtful edge by all scans of both sides; see verify_edges().
struct EdgeVerified {
  std::size_t reference_index = 0;
  std::size_t query_index = 0;
  const std::vector<MatchCandidate>& candidates;      ///< the candidates of EdgeFound, and further ones
  const std::vector<EdgeSupport>& support_by_others;  ///< support of each candidate by other scans
  const std::vector<double>& parallel_support;        ///< support of each candidate by parallel edges
  std::size_t in_map = 0;                             ///< the candidate in the map before
  std::size_t candidate = 0;                          ///< the best candidate
  double probability = 0.0;                           ///< probability that the best is right
};

/// A loop that was accepted or refused.
struct LoopJudged {
  ClosedLoop loop;
  bool is_accepted = false;
  std::string why_not;  ///< one line that says why it was refused; empty when it was accepted
};

/// The keyframes that others replace from now on.
struct KeyframesCulled {
  std::vector<std::size_t> scans;
  std::size_t num_left = 0;
};

/// Whether the place of the robot in the optimised part of the map is known.
struct RobotLocalized {
  std::size_t scan = 0;  ///< the last keyframe
  bool is_lost = false;
};

/// All functions do nothing unless they are overridden. Only keep_going() of a listener can change a result. An
/// exception of a listener ends the call of the mapper that it listens to. The references of an event are valid during
/// the call only. Calls never overlap. All come from the thread that calls the mapper; with LiveOptions::in_background,
/// on_edge() and the functions below it are called from another thread, and on_stage(), on_progress() and keep_going()
/// only from Mapper::finish().
///
/// RunObserver adds stages, progress, warnings, and the question whether to go on; PaperListener adds the shape of each
/// scan, and the alignments of the paper's method.
struct MappingEvents : RunObserver, PaperListener {
  /// A scan was pushed, and has a pose by its match.
  virtual void on_scan(const ScanUpdate& /*scan*/) {}
  /// All candidates of an edge were found that are searched before the whole map is known.
  virtual void on_edge(const EdgeFound& /*edge*/) {}
  /// After each optimisation of the graph, the function is called for all loops that were considered.
  virtual void on_loop(const LoopJudged& /*loop*/) {}
  virtual void on_culled(const KeyframesCulled& /*culled*/) {}
  /// The robot was lost, or found again.
  virtual void on_localization(const RobotLocalized& /*localized*/) {}
  /// A map was published.
  virtual void on_map(const Map& /*map*/) {}
  /// The function is called at the end for each verified edge, in the order of edges.
  virtual void on_edge_verified(const EdgeVerified& /*edge*/) {}
  /// An edge was judged, which happens at the end, or when one of its keyframes is culled.
  virtual void on_edge_chosen(const EdgeChosen& /*edge*/) {}
};

/// Passes each event on to several listeners, in their order. The run goes on while all of them want it to.
class EventFanOut : public MappingEvents {
 public:
  /// Keeps the pointers, none of which may be null.
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
