// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <deque>

#include "mapper/methods.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/paper/paper_align.hpp"

namespace shapemap {
namespace {

/// A placed scan that later ones are aligned to.
struct RecentScan {
  PlacedScan placed;
  TargetScan scan;  ///< in the robot's frame, with the corrections of its sub-scans
};

/// The chain of the paper: each scan against the partial map of the few before it.
class PaperChain {
 public:
  PaperChain(const MappingOptions& options, RunObserver& observer, TraceSink* sink) : options_(options), sink_(sink) {
    options_.align.keep_going = [&observer] { return observer.keep_going(); };
    options_.align.threads = options.run.threads;
    options_.align.min_points = options.shape.min_points;
  }

  void add(std::size_t index, const Scan& scan, MapResult& result) {
    const auto start = std::chrono::steady_clock::now();
    const Shape shape = shape_of(scan, options_.returns, options_.polylines, options_.shape);
    result.times.shape_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (sink_) sink_->on_shape(index, shape.points);

    ScanResult outcome;
    outcome.scan_index = index;
    outcome.timestamp_s = scan.timestamp_s;
    if (shape.size() < static_cast<std::size_t>(options_.shape.min_points)) {
      outcome.match.status = MatchStatus::kNoShape;
      outcome.reason = "only " + std::to_string(shape.size()) + " shape points, " +
                       std::to_string(options_.shape.min_points) + " are needed";
      recent_.clear();
    } else {
      place(scan, shape, outcome, result);
    }
    result.scans.push_back(std::move(outcome));
  }

 private:
  void place(const Scan& scan, const Shape& shape, ScanResult& outcome, MapResult& result) {
    PlacedScan placed;
    placed.scan_index = outcome.scan_index;
    placed.timestamp_s = scan.timestamp_s;
    placed.robot_from_sweep.resize(scan.sweeps.size());
    outcome.starts_component = true;
    if (!recent_.empty()) {
      outcome.match = aligned(outcome.scan_index, shape);
      add_times(outcome.match, result.times);
      outcome.reason = outcome.match.reason;
      if (outcome.match.ok()) {
        outcome.starts_component = false;
        placed.map_from_robot = recent_.back().placed.map_from_robot * outcome.match.ref_from_query;
        placed.robot_from_sweep = outcome.match.query_from_sweep;
      } else {
        recent_.clear();
      }
    }
    if (outcome.starts_component) result.components.emplace_back();
    outcome.component = static_cast<int>(result.components.size()) - 1;
    recent_.push_back(
        {placed, target_scan(moved(shape, {}, placed.robot_from_sweep), options_.align.histogram.radius_m)});
    if (recent_.size() > static_cast<std::size_t>(options_.align.target.target_scans)) recent_.pop_front();
    result.components.back().scans.push_back(std::move(placed));
  }

  ScanMatch aligned(std::size_t index, const Shape& shape) const {
    if (!sink_) return align(target(), shape, options_.align);
    AlignTrace steps;
    ScanMatch alignment = align(target(), shape, options_.align, &steps);
    std::vector<TracedTarget> targets;
    for (const RecentScan& recent : recent_) {
      targets.push_back(
          {recent.placed.scan_index, recent.scan.shape.size(), ref_from_robot(recent), recent.placed.robot_from_sweep});
    }
    sink_->on_alignment({index, std::move(targets), alignment, steps});
    return alignment;
  }

  Pose2 ref_from_robot(const RecentScan& recent) const {
    return inverse(recent_.back().placed.map_from_robot) * recent.placed.map_from_robot;
  }

  /// The recent scans in the frame of the latest.
  PartialMap target() const {
    std::vector<TargetScan> scans;
    for (const RecentScan& recent : recent_) scans.push_back(moved(recent.scan, ref_from_robot(recent)));
    if (options_.align.lcs.target == LcsTarget::kPerScan) return PartialMap(std::move(scans));
    std::vector<Shape> shapes;
    shapes.reserve(scans.size());
    for (const TargetScan& scan : scans) shapes.push_back(scan.shape);
    return {shapes, true, options_.align.histogram.radius_m};
  }

  static void add_times(const ScanMatch& alignment, StageTimes& times) {
    times.align_s += alignment.match_s;
    times.icp_s += alignment.icp_s;
    times.decoupled_icp_s += alignment.decoupled_icp_s;
  }

  MappingOptions options_;
  TraceSink* sink_;
  std::deque<RecentScan> recent_;
};

}  // namespace

void chain_by_paper(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink,
                    MapResult& result) {
  PaperChain chain(options, observer, sink);
  observer.on_stage("chain");
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    if (!observer.keep_going()) throw Interrupted();
    chain.add(i, log.scans[i], result);
    observer.on_progress(i + 1, log.scans.size());
  }
}

}  // namespace shapemap
