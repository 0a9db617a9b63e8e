// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <limits>
#include <map>

#include "edge_verdict.hpp"
#include "front_end.hpp"
#include "inference/doubtful_edges.hpp"
#include "inference/optimized_map.hpp"
#include "inference/sweep_poses.hpp"
#include "keyframe_culling.hpp"
#include "localization/revisit_tracking.hpp"
#include "loops/loop_candidates.hpp"
#include "methods.hpp"
#include "motion/trajectory_smoothing.hpp"
#include "shapemap/core/errors.hpp"

namespace shapemap {
namespace {

/// Of a pose in the frame of the map.
Eigen::Matrix3d covariance_in_map(const ScanMatch& match, const Pose2& map_from_robot) {
  Eigen::Matrix3d map_from_reference = Eigen::Matrix3d::Identity();
  const double heading_rad = map_from_robot.theta_rad - match.ref_from_query.theta_rad;
  map_from_reference.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(heading_rad).toRotationMatrix();
  return map_from_reference * match.covariance * map_from_reference.transpose();
}

/// Gives each position of the log its place in `result`.
class Placing {
 public:
  Placing(const Log& log, const KeyframeGraph& graph, const OptimizedMap& map, const SweepCorrections& sweeps,
          const MappingOptions& options, TraceSink* sink, MapResult& result)
      : log_(log), graph_(graph), map_(map), sweeps_(sweeps), options_(options), sink_(sink), result_(result) {}

  void run() {
    for (std::size_t i = 0; i < graph_.keyframes.size(); ++i) place_keyframe(i);
    for (const AttachedScan& scan : graph_.attached) place_attached(scan);
    for (Component& component : result_.components) {
      std::sort(component.scans.begin(), component.scans.end(),
                [](const PlacedScan& a, const PlacedScan& b) { return a.scan_index < b.scan_index; });
      smooth(component);
      const Pose2 first_from_map = inverse(component.scans.front().map_from_robot);
      for (PlacedScan& placed : component.scans) placed.map_from_robot = first_from_map * placed.map_from_robot;
    }
  }

 private:
  void place_keyframe(std::size_t i) {
    ScanResult& outcome = result_.scans[graph_.keyframes[i].scan_index];
    if (i > 0 && !graph_.edges[i - 1].culled_covariance) {
      judge_edge(graph_, map_, i - 1, options_.robust.matcher.confidence, sink_, outcome);
    }
    outcome.component = component_of(i);
    outcome.starts_component = i == 0 || map_.component[i] != map_.component[i - 1];
    PlacedScan& placed = add(outcome, map_.map_from_keyframe[i]);
    if (!sweeps_.empty()) placed.robot_from_sweep = sweeps_[i];
  }

  void place_attached(const AttachedScan& scan) {
    ScanResult& outcome = result_.scans[scan.scan_index];
    outcome.match = judged({scan.pose}, 0, kFullMargin, options_.robust.matcher.confidence);
    outcome.reference = graph_.keyframes[scan.keyframe].scan_index;
    outcome.is_keyframe = false;
    outcome.component = component_of(scan.keyframe);
    add(outcome, map_.map_from_keyframe[scan.keyframe] * scan.pose.ref_from_query);
  }

  /// Fragments are numbered in the order of the log.
  int component_of(std::size_t keyframe) {
    const auto [found, is_new] =
        number_of_component_.try_emplace(map_.component[keyframe], static_cast<int>(result_.components.size()));
    if (is_new) result_.components.emplace_back();
    return found->second;
  }

  /// Scans that keyframes stand for are placed one by one: their motion is smoothed.
  void smooth(Component& component) const {
    std::vector<TrackedPose> poses;
    for (const PlacedScan& placed : component.scans) {
      const ScanResult& outcome = result_.scans[placed.scan_index];
      TrackedPose pose{placed.scan_index, outcome.session, placed.map_from_robot, {}};
      if (!outcome.is_keyframe) pose.covariance = covariance_in_map(outcome.match, placed.map_from_robot);
      poses.push_back(pose);
    }
    smooth_trajectory(poses);
    for (std::size_t i = 0; i < poses.size(); ++i) component.scans[i].map_from_robot = poses[i].map_from_robot;
  }

  PlacedScan& add(const ScanResult& outcome, const Pose2& map_from_robot) {
    PlacedScan placed;
    placed.scan_index = outcome.scan_index;
    placed.timestamp_s = outcome.timestamp_s;
    placed.map_from_robot = map_from_robot;
    placed.robot_from_sweep.resize(log_.scans[placed.scan_index].sweeps.size());
    std::vector<PlacedScan>& scans = result_.components[static_cast<std::size_t>(outcome.component)].scans;
    scans.push_back(std::move(placed));
    return scans.back();
  }

  const Log& log_;
  const KeyframeGraph& graph_;
  const OptimizedMap& map_;
  const SweepCorrections& sweeps_;
  const MappingOptions& options_;
  TraceSink* sink_;
  MapResult& result_;
  std::map<std::size_t, int> number_of_component_;
};

/// After an interrupt nothing more is read, or looked for; what was read is still made one map.
class Finishing : public RunObserver {
 public:
  explicit Finishing(RunObserver& observer) : observer_(observer) {}
  void on_stage(std::string_view stage) override { observer_.on_stage(stage); }
  void on_progress(std::size_t done, std::size_t total) override { observer_.on_progress(done, total); }
  void on_warning(std::string_view message) override { observer_.on_warning(message); }

 private:
  RunObserver& observer_;
};

/// So many new keyframes are followed in the settled map at a time.
constexpr std::size_t kFollowedAtOnce = 64;

/// Reads the log. When there are many keyframes, loops are closed, and those that are there twice let go. From then on,
/// those of places that are known again go soon; all is solved anew when there are many more.
class Reading {
 public:
  Reading(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink, MatchCache* store,
          MapResult& result)
      : options_(options),
        observer_(observer),
        sink_(sink),
        store_(store),
        result_(result),
        growth_(log, options, observer, sink, store, result),
        revisit_tracker_(options.robust) {}

  void run() {
    const auto settle_at = std::max(static_cast<std::size_t>(options_.robust.keyframes.settle_at), 4 * kKeyframesInUse);
    const bool settles = options_.robust.loops.close_loops && options_.robust.keyframes.settle_at > 0;
    std::size_t most = settles ? settle_at : std::numeric_limits<std::size_t>::max();
    // Without loops, what was read is let go now and then.
    std::size_t next = options_.robust.loops.close_loops ? most : settle_at;
    while (growth_.extend(next)) {
      const auto start = std::chrono::steady_clock::now();
      if (graph().keyframes.size() < most) {
        if (has_settled_) follow();
      } else if (settle()) {
        has_settled_ = true;
        most = std::max(settle_at, 2 * graph().keyframes.size());
      } else {
        most = graph().keyframes.size() + settle_at / 2;
      }
      next = std::min(most, graph().keyframes.size() + kFollowedAtOnce);
      result_.times.loops_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
  }

  KeyframeGraph& graph() { return growth_.graph(); }
  LoopCandidates& known() { return known_; }

 private:
  Execution execution() const { return {options_.run.threads, observer_}; }
  LoopSearch loop_search() const {
    return {options_.robust.matcher.search, options_.robust.loop_detection, execution(), store_};
  }

  /// False where the map is not right yet: what it has at one place does not look the same. The more there is of the
  /// log, the more loops tell.
  bool settle() {
    find_loops(graph(), graph().keyframes.size() - kKeyframesInUse, loop_search(), known_);
    if (!observer_.keep_going()) return false;
    OptimizedMap map = optimized_map(graph(), known_.candidates, Improbable::kIsCut, options_.robust, execution());
    if (!observer_.keep_going()) return false;
    const RedundantKeyframes redundant = find_redundant_keyframes(graph(), map, options_.robust, options_.run.threads);
    if (!redundant.are_of_right_map()) return false;
    for (std::size_t b = 0; b < map.component.size(); ++b) {
      if (redundant.is_in_doubt[b]) map.component[b] = b;  // the robot is not to be followed there
    }
    retire(redundant.of_keyframe, map);
    revisit_tracker_.start(graph(), map, graph().keyframes.size() - kKeyframesInUse);
    return true;
  }

  void follow() {
    if (revisit_tracker_.is_lost()) {
      find_loops(graph(), graph().keyframes.size() - kKeyframesInUse, loop_search(), known_);
      if (!observer_.keep_going()) return;
    }
    RevisitTracker::Followed followed = revisit_tracker_.follow(graph(), known_.candidates);
    const std::size_t num_open = graph().keyframes.size() - followed.num_followed;
    retire(followed.redundant, followed.map);
    revisit_tracker_.renew(std::move(followed.map), num_open);
  }

  void retire(const std::vector<std::optional<ReplacementKeyframe>>& redundant, OptimizedMap& map) {
    for (std::size_t i = 0; i < graph().edges.size(); ++i) {
      const bool stays = !redundant[i] && !redundant[i + 1];
      if (!stays && !graph().edges[i].culled_covariance) judge(map, i);
    }
    cull_keyframes(redundant, options_, map, graph(), known_);
  }

  /// A link that goes has its verdict now.
  void judge(const OptimizedMap& map, std::size_t edge) {
    ScanResult& outcome = result_.scans[graph().keyframes[edge + 1].scan_index];
    judge_edge(graph(), map, edge, options_.robust.matcher.confidence, sink_, outcome);
  }

  const MappingOptions& options_;
  RunObserver& observer_;
  TraceSink* sink_;
  MatchCache* store_;
  MapResult& result_;
  FrontEnd growth_;
  RevisitTracker revisit_tracker_;
  bool has_settled_ = false;
  LoopCandidates known_;
};

void trace_revised(const KeyframeGraph& graph, TraceSink& sink) {
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const OdometryEdge& edge = graph.edges[i];
    if (!edge.verified) continue;
    sink.on_revision({graph.keyframes[i].scan_index, graph.keyframes[i + 1].scan_index, edge.candidates,
                      edge.verified->support_by_others, edge.verified->parallel_support, edge.verified->in_map,
                      edge.verified->candidate, edge.verified->probability});
  }
}

}  // namespace

void map_robustly(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink,
                  MatchCache* store, MapResult& result) {
  Reading reading(log, options, observer, sink, store, result);
  reading.run();
  const auto start = std::chrono::steady_clock::now();
  Finishing finishing(observer);
  const auto unless_interrupted = [&]() -> RunObserver& { return observer.keep_going() ? observer : finishing; };

  const auto execution = [&](RunObserver& asked) { return Execution{options.run.threads, asked}; };

  KeyframeGraph& graph = reading.graph();
  OptimizedMap map;
  if (options.robust.loops.close_loops) {
    find_loops(graph, graph.keyframes.size(),
               {options.robust.matcher.search, options.robust.loop_detection, execution(unless_interrupted()), store},
               reading.known());
    const Improbable improbable =
        options.robust.edge_verification.doubt_below > 0.0 ? Improbable::kStays : Improbable::kIsCut;
    map = optimized_map(graph, reading.known().candidates, improbable, options.robust, execution(unless_interrupted()));
  } else {
    map = map_of_odometry(graph, options.robust);
  }
  const Execution rest = execution(unless_interrupted());
  SweepCorrections sweeps = refine_sweeps_of_map(graph, options.robust, rest, map);
  if (options.robust.loops.close_loops && verify_doubtful_edges(options.robust, rest, store, graph, map)) {
    sweeps = refine_sweeps_of_map(graph, options.robust, rest, map);
  }
  result.times.loops_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.loops = std::move(map.loops);
  if (sink) trace_revised(graph, *sink);
  Placing(log, graph, map, sweeps, options, sink, result).run();
  if (!observer.keep_going()) throw Interrupted();
}

}  // namespace shapemap
