// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/paper_mapper.hpp"

#include <utility>

#include "shapemap/core/errors.hpp"
#include "shapemap/core/stopwatch.hpp"
#include "shapemap/scan/plausibility.hpp"

namespace shapemap {
namespace {

void require_plausible(const Scan& scan, std::size_t scan_index) {
  const std::string fault = implausibility(scan);
  if (!fault.empty()) throw InputError("position " + std::to_string(scan_index) + ": " + fault);
}

}  // namespace

PaperMapper::PaperMapper(PaperMapperOptions options, const Execution& execution, PaperListener* listener)
    : options_(std::move(options)), execution_(execution), listener_(listener) {
  validate_all(options_);
}

const PaperScanResult& PaperMapper::add_scan(const Scan& scan) {
  PaperScanResult outcome;
  outcome.scan_index = result_.scans.size();
  outcome.timestamp_s = scan.timestamp_s;
  require_plausible(scan, outcome.scan_index);
  const Stopwatch watch;
  const Shape shape = shape_of(scan, options_.returns, options_.polylines, options_.shape);
  const double shape_s = watch.seconds();
  if (listener_) listener_->on_shape(outcome.scan_index, shape.points);

  if (shape.size() < static_cast<std::size_t>(options_.shape.min_points)) {
    outcome.alignment.emplace().reason = "only " + std::to_string(shape.size()) + " shape points, " +
                                         std::to_string(options_.shape.min_points) + " are needed";
    recent_.clear();
  } else {
    if (!recent_.empty()) outcome.alignment = aligned(shape);
    place(scan, shape, outcome);
  }
  result_.shape_s += shape_s;
  result_.scans.push_back(std::move(outcome));
  return result_.scans.back();
}

void PaperMapper::place(const Scan& scan, const Shape& shape, PaperScanResult& outcome) {
  PlacedScan placed;
  placed.scan_index = outcome.scan_index;
  placed.timestamp_s = scan.timestamp_s;
  if (outcome.alignment && outcome.alignment->ok()) {
    placed.map_from_robot = recent_.back().placed.map_from_robot * outcome.alignment->ref_from_query;
    placed.robot_from_sweep = outcome.alignment->query_from_sweep;
  } else {
    placed.robot_from_sweep.resize(scan.sweeps.size());
    outcome.starts_component = true;
    recent_.clear();
    result_.components.emplace_back();
  }
  outcome.component = static_cast<int>(result_.components.size()) - 1;
  recent_.push_back(
      {placed, target_scan(moved(shape, {}, placed.robot_from_sweep), options_.method.histogram.radius_m)});
  if (recent_.size() > static_cast<std::size_t>(options_.method.target.target_scans)) recent_.pop_front();
  result_.components.back().scans.push_back(std::move(placed));
}

PaperAlignment PaperMapper::aligned(const Shape& shape) const {
  RunObserver& observer = execution_.observer;
  const PaperRun run{execution_.threads, options_.shape.min_points, [&observer] { return observer.keep_going(); }};
  if (!listener_) return paper_align(target(), shape, options_.method, run);
  PaperTrace steps;
  PaperAlignment alignment = paper_align(target(), shape, options_.method, run, &steps);
  std::vector<TracedTarget> targets;
  for (const RecentScan& recent : recent_) {
    targets.push_back(
        {recent.placed.scan_index, recent.scan.shape.size(), ref_from_robot(recent), recent.placed.robot_from_sweep});
  }
  listener_->on_alignment({result_.scans.size(), std::move(targets), alignment, steps});
  return alignment;
}

/// The reference of a partial map is the latest of its scans.
Pose2 PaperMapper::ref_from_robot(const RecentScan& recent) const {
  return inverse(recent_.back().placed.map_from_robot) * recent.placed.map_from_robot;
}

PartialMap PaperMapper::target() const {
  std::vector<TargetScan> scans;
  for (const RecentScan& recent : recent_) scans.push_back(moved(recent.scan, ref_from_robot(recent)));
  if (options_.method.lcs.target == LcsTarget::kPerScan) return PartialMap(std::move(scans));
  std::vector<Shape> shapes;
  shapes.reserve(scans.size());
  for (const TargetScan& scan : scans) shapes.push_back(scan.shape);
  return {shapes, true, options_.method.histogram.radius_m};
}

}  // namespace shapemap
