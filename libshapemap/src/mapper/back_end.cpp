// SPDX-License-Identifier: GPL-3.0-or-later
#include "back_end.hpp"

#include <algorithm>
#include <utility>

#include "edge_verdict.hpp"
#include "inference/doubtful_edges.hpp"
#include "inference/sweep_poses.hpp"
#include "keyframe_culling.hpp"
#include "localization/localization_numbers.hpp"
#include "map_snapshot.hpp"
#include "mapper_numbers.hpp"
#include "motion_rescoring.hpp"
#include "shapemap/core/stopwatch.hpp"
#include "three_scan_scores.hpp"
#include "trajectory_builder.hpp"

namespace shapemap {
namespace {

constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

/// Each preview has half as many keyframes again, so that all previews together cost a few times as much as the last.
std::size_t preview_after(std::size_t num_keyframes) { return num_keyframes + (num_keyframes + 1) / 2; }

/// Never asks to stop: after an interrupt, the map of what was found must still be finished.
class Finishing : public RunObserver {
 public:
  explicit Finishing(RunObserver& observer) : observer_(observer) {}
  void on_stage(std::string_view stage) override { observer_.on_stage(stage); }
  void on_progress(std::size_t done, std::size_t total) override { observer_.on_progress(done, total); }
  void on_warning(std::string_view message) override { observer_.on_warning(message); }

 private:
  RunObserver& observer_;
};

/// Passes on only the question whether to keep going.
class Quiet : public RunObserver {
 public:
  explicit Quiet(RunObserver& observer) : observer_(observer) {}
  bool keep_going() override { return observer_.keep_going(); }

 private:
  RunObserver& observer_;
};

void tell_loops(const OptimizedMap& map, MappingEvents& events) {
  for (const ClosedLoop& loop : map.loops) events.on_loop({loop, true, ""});
  for (const RefusedLoop& refused : map.refused_loops) events.on_loop({refused.loop, false, refused.why});
}

void tell_verified(const KeyframeGraph& graph, MappingEvents& events) {
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const OdometryEdge& edge = graph.edges[i];
    if (!edge.verified) continue;
    events.on_edge_verified({graph.keyframes[i].scan_index, graph.keyframes[i + 1].scan_index, edge.candidates,
                             edge.verified->support_by_others, edge.verified->parallel_support, edge.verified->in_map,
                             edge.verified->candidate, edge.verified->probability});
  }
}

}  // namespace

BackEnd::BackEnd(BackEndContext context) : context_(std::move(context)), revisits_(context_.options.robust) {
  const KeyframeOptions& keyframes = context_.options.robust.keyframes;
  cull_at_ = std::max(static_cast<std::size_t>(keyframes.settle_at), 4 * kLocalization.redundancy.keyframes_in_use);
  next_optimization_ = closes_loops() && keyframes.settle_at > 0 ? cull_at_ : kNever;
  // Without loops, updates only release memory.
  next_update_ = closes_loops() ? next_optimization_ : cull_at_;
  next_preview_ = closes_loops() && context_.publish ? kMapper.updates.first_preview : kNever;
  if (next_preview_ != kNever) preview_cache_.emplace(context_.cache);
}

void BackEnd::add(TrackedScan scan) {
  const std::size_t num_scans = result_.scans.size();
  if (num_scans > 0 && num_scans % kMapper.updates.scans_between_updates == 0 &&
      graph_.keyframes.size() >= next_update_)
    update();
  ScanResult outcome;
  outcome.scan_index = scan.scan_index;
  outcome.timestamp_s = scan.timestamp_s;
  outcome.session = scan.session;
  if (scan.attached) {
    graph_.attached.push_back({scan.scan_index, graph_.keyframes.size() - 1, std::move(*scan.attached)});
  } else if (scan.keyframe) {
    if (!graph_.keyframes.empty()) graph_.edges.push_back(std::move(scan.keyframe->edge));
    graph_.keyframes.push_back(std::move(scan.keyframe->keyframe));
  } else {
    outcome.match.status = MatchStatus::kNoShape;
    outcome.reason = "only " + std::to_string(scan.view->size()) + " shape points, " +
                     std::to_string(context_.options.shape.min_points) + " are needed";
  }
  result_.scans.push_back(std::move(outcome));
  num_sweeps_.push_back(scan.num_sweeps);
  if (!is_following_ && graph_.keyframes.size() >= next_preview_) preview();
}

LoopSearch BackEnd::loop_search(const Execution& execution) {
  const RobustOptions& options = context_.options.robust;
  return {options.matcher.search, options.loop_detection, execution, cache()};
}

void BackEnd::update() {
  choose_odometry();
  const Stopwatch watch;
  if (graph_.keyframes.size() < next_optimization_) {
    if (is_following_) follow();
  } else if (optimize_and_cull()) {
    is_following_ = true;
    preview_cache_.reset();
    preview_loops_ = {};
    next_optimization_ = std::max(cull_at_, 2 * graph_.keyframes.size());
  } else {
    next_optimization_ = graph_.keyframes.size() + cull_at_ / 2;
  }
  next_update_ = std::min(next_optimization_, graph_.keyframes.size() + kMapper.updates.followed_at_once);
  result_.times.loops_s += watch.seconds();
  context_.events.on_stage("chain");
}

/// Chooses a candidate of each edge by the neighbouring edges and by the learned motion prior.
void BackEnd::choose_odometry() {
  const Stopwatch watch;
  const RobustOptions& options = context_.options.robust;
  const int threads = context_.options.run.threads;
  add_three_scan_scores(options, threads, graph_);
  choose_candidates(graph_);
  const std::vector<std::size_t> completed = rescore_by_motion(options, threads, graph_);
  choose_candidates(graph_);
  if (!closes_loops()) release_views();
  result_.times.align_s += watch.seconds();
  for (const std::size_t i : completed) {
    const OdometryEdge& edge = graph_.edges[i];
    if (edge.candidates.empty()) continue;
    context_.events.on_edge({graph_.keyframes[i].scan_index, graph_.keyframes[i + 1].scan_index, edge.candidates,
                             edge.num_own, edge.insufficient_view});
  }
}

/// Keeps the views of the last keyframes only, which the scores of coming edges need.
void BackEnd::release_views() {
  const std::size_t needed = static_cast<std::size_t>(context_.options.robust.front_end.more_references) + 2;
  for (std::size_t i = 0; i + needed < graph_.keyframes.size(); ++i) graph_.keyframes[i].view.reset();
}

/// Returns false where the map is not right yet, because scans of one place do not look the same. Later loops may
/// correct it.
bool BackEnd::optimize_and_cull() {
  const RobustOptions& options = context_.options.robust;
  const std::size_t num_settled = graph_.keyframes.size() - kLocalization.redundancy.keyframes_in_use;
  find_loops(graph_, num_settled, loop_search(execution()), loops_);
  if (!context_.events.keep_going()) return false;
  OptimizedMap map = optimized_map(graph_, loops_.candidates, Improbable::kIsCut, options, execution());
  if (!context_.events.keep_going()) return false;
  tell_loops(map, context_.events);
  publish(graph_, map);
  const RedundantKeyframes redundant = find_redundant_keyframes(graph_, map, options, context_.options.run.threads);
  if (!redundant.are_of_right_map()) return false;
  for (std::size_t b = 0; b < map.component.size(); ++b) {
    if (redundant.is_in_doubt[b]) map.component[b] = b;  // the robot must not be localized there
  }
  cull(redundant.of_keyframe, map);
  revisits_.start(graph_, map, graph_.keyframes.size() - kLocalization.redundancy.keyframes_in_use);
  tell_localization();
  return true;
}

/// Localizes the new keyframes in the map, and culls the redundant ones.
void BackEnd::follow() {
  if (revisits_.is_lost()) {
    find_loops(graph_, graph_.keyframes.size() - kLocalization.redundancy.keyframes_in_use, loop_search(execution()),
               loops_);
    if (!context_.events.keep_going()) return;
  }
  RevisitTracker::Followed followed = revisits_.follow(graph_, loops_.candidates);
  publish(graph_, followed.map);
  const std::size_t num_open = graph_.keyframes.size() - followed.num_followed;
  cull(followed.redundant, followed.map);
  revisits_.renew(std::move(followed.map), num_open);
  tell_localization();
}

void BackEnd::tell_localization() {
  if (revisits_.is_lost() == is_lost_) return;
  is_lost_ = revisits_.is_lost();
  context_.events.on_localization({graph_.keyframes.back().scan_index, is_lost_});
}

/// Judges the edges of culled keyframes now, since they leave the graph with them.
void BackEnd::cull(const std::vector<std::optional<ReplacementKeyframe>>& redundant, OptimizedMap& map) {
  for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
    const bool stays = !redundant[i] && !redundant[i + 1];
    if (stays || graph_.edges[i].culled_covariance) continue;
    ScanResult& outcome = result_.scans[graph_.keyframes[i + 1].scan_index];
    const std::optional<EdgeChosen> chosen =
        judge_edge(graph_, map, i, context_.options.robust.matcher.confidence, outcome);
    if (chosen) context_.events.on_edge_chosen(*chosen);
  }
  KeyframesCulled culled;
  for (std::size_t i = 0; i < redundant.size(); ++i) {
    if (redundant[i]) culled.scans.push_back(graph_.keyframes[i].scan_index);
  }
  culled.num_left = graph_.keyframes.size() - culled.scans.size();
  if (!culled.scans.empty()) context_.events.on_culled(culled);
  cull_keyframes(redundant, context_.options, map, graph_, loops_);
}

void BackEnd::publish(const KeyframeGraph& graph, const OptimizedMap& map) const {
  if (context_.publish) context_.publish(map_snapshot(graph, map, result_.scans.size()));
}

/// Publishes a map of the keyframes so far, made from a copy of the graph, because finish() must not depend on it.
void BackEnd::preview() {
  const RobustOptions& options = context_.options.robust;
  Quiet quiet(context_.events);
  const Execution execution{context_.options.run.threads, quiet};
  KeyframeGraph graph = graph_;
  add_three_scan_scores(options, execution.threads, graph);
  choose_candidates(graph);
  find_loops(graph, graph.keyframes.size(), loop_search(execution), preview_loops_);
  const OptimizedMap map = optimized_map(graph, preview_loops_.candidates, Improbable::kIsCut, options, execution);
  if (quiet.keep_going()) publish(graph, map);
  next_preview_ = preview_after(graph.keyframes.size());
}

MapResult BackEnd::finish() {
  choose_odometry();
  const Stopwatch watch;
  const RobustOptions& options = context_.options.robust;
  Finishing finishing(context_.events);
  const auto unless_interrupted = [&] {
    RunObserver& events = context_.events;
    RunObserver& asked = context_.events.keep_going() ? events : finishing;
    return Execution{context_.options.run.threads, asked};
  };
  OptimizedMap map;
  if (closes_loops()) {
    find_loops(graph_, graph_.keyframes.size(), loop_search(unless_interrupted()), loops_);
    const Improbable improbable = options.edge_verification.doubt_below > 0.0 ? Improbable::kStays : Improbable::kIsCut;
    map = optimized_map(graph_, loops_.candidates, improbable, options, unless_interrupted());
  } else {
    map = map_of_odometry(graph_, options);
  }
  const Execution rest = unless_interrupted();
  SweepCorrections sweeps = refine_sweeps_of_map(graph_, options, rest, map);
  if (closes_loops() && verify_doubtful_edges(options, rest, cache(), graph_, map)) {
    sweeps = refine_sweeps_of_map(graph_, options, rest, map);
  }
  result_.times.loops_s += watch.seconds();
  tell_loops(map, context_.events);
  result_.loops = std::move(map.loops);
  tell_verified(graph_, context_.events);
  build_trajectory({graph_, map, sweeps}, num_sweeps_, options.matcher.confidence, context_.events, result_);
  result_.interrupted = !context_.events.keep_going();
  return std::move(result_);
}

}  // namespace shapemap
