// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace_json.hpp"

#include "shapemap/core/version.hpp"
#include "shapemap/scan/joined_logs.hpp"

namespace shapemap {
namespace {

Json point_array(const Point2& p) { return Json::array({p.x(), p.y()}); }

Json polylines_json(const Sweep& sweep, int index, const MappingOptions& options) {
  const SweepShape shape = sweep_shape(sweep, index, options.returns, options.polylines, options.shape);
  Json scan_points = Json::array();
  for (const ScanPoint& point : shape.scan_points) scan_points.push_back(point_array(point.p_m));
  Json segments = Json::array();
  for (const LineSegment& s : shape.polylines.segments) {
    segments.push_back(Json::array({s.start_m.x(), s.start_m.y(), s.end_m.x(), s.end_m.y()}));
  }
  return {{"scan_points", scan_points},
          {"segments", segments},
          {"closest_segment", shape.polylines.closest_segment},
          {"em_iterations", shape.polylines.iterations}};
}

/// Writes bins and values in turn, without the empty ones, of which there are many.
Json histograms_json(const std::vector<ShapePoint>& points, const HistogramOptions& options) {
  Json all = Json::array();
  const NeighbourDirections directions(Shape{points, 0}, options.radius_m);
  for (const AngularHistogram& histogram : directions.histograms(0.0, options.norm)) {
    Json bins = Json::array();
    for (std::size_t b = 0; b < kHistogramBins; ++b) {
      if (histogram.bins[b] == 0) continue;
      bins.push_back(b);
      bins.push_back(histogram.bins[b]);
    }
    all.push_back(bins);
  }
  return all;
}

/// Writes correspondences as [query point, target scan, target point], by their index in the records of the scans.
class PairNames {
 public:
  PairNames(const std::vector<TracedTarget>& targets, LcsTarget target) : targets_(targets), target_(target) {}

  Json operator()(const Correspondences& pairs) const {
    Json all = Json::array();
    for (const Correspondence& pair : pairs) {
      std::size_t scan = pair.target_scan;
      std::size_t point = pair.indices.target;
      // One long sequence has the points of all scans, one after the other.
      while (target_ == LcsTarget::kConcatenated && point >= targets_[scan].num_points) {
        point -= targets_[scan++].num_points;
      }
      all.push_back(Json::array({pair.indices.query, targets_.at(scan).scan_index, point}));
    }
    return all;
  }

 private:
  const std::vector<TracedTarget>& targets_;
  LcsTarget target_;
};

Json rotation_json(const RotationMatch& match) {
  std::size_t num_in_segments = 0;
  for (const Correspondences& segment : match.segments) num_in_segments += segment.size();
  const bool has_pose = match.translation.num_correspondences > 0;
  return {{"rotation_rad", match.rotation_rad},
          {"num_lcs", match.lcs.size()},
          {"num_spread", match.spread.size()},
          {"num_in_segments", num_in_segments},
          {"num_kept", match.translation.num_correspondences},
          {"mean_distance_m", match.translation.mean_distance_m},
          {"overlap", match.overlap.num_points},
          {"target_from_query", has_pose ? pose_array(match.target_from_query()) : Json(nullptr)}};
}

Json targets_json(const std::vector<TracedTarget>& targets) {
  Json all = Json::array();
  for (const TracedTarget& target : targets) {
    all.push_back({{"position", target.scan_index},
                   {"ref_from_robot", pose_array(target.ref_from_robot)},
                   {"robot_from_sub_scan", pose_arrays(target.robot_from_sweep)}});
  }
  return all;
}

void add_best_rotation(const TracedAlignment& traced, LcsTarget target, Json& all) {
  const PaperTrace& steps = traced.steps;
  all["best_rotation"] = nullptr;
  for (const char* name : {"lcs", "spread", "segments", "kept"}) all[name] = Json::array();
  if (steps.best_rotation < 0) return;
  const RotationMatch& best = steps.rotations.at(static_cast<std::size_t>(steps.best_rotation));
  const PairNames names(traced.targets, target);
  all["best_rotation"] = steps.best_rotation;
  all["lcs"] = names(best.lcs);
  all["spread"] = names(best.spread);
  for (const Correspondences& segment : best.segments) all["segments"].push_back(names(segment));
  all["kept"] = names(best.translation.kept);
}

Json candidates_json(const std::vector<MatchCandidate>& candidates) {
  Json all = Json::array();
  for (const MatchCandidate& candidate : candidates) {
    all.push_back(ranked_json(ranked_pose(candidate)));
    all.back()["covariance"] = covariance_json(pose_covariance(candidate.fit));
  }
  return all;
}

}  // namespace

Json run_json(const TracedRun& run) {
  Json options = Json::object();
  add_options(run.reading, options);
  add_options(run.selection, options);
  MappingOptions::groups(run.mapping, [&](const char*, const auto& group) { add_options(group, options); });
  options.erase("threads");  // the number of threads changes no result
  Json logs = Json::array();
  for (const LogPart& part : parts_of(run.log)) {
    logs.push_back({{"path", run.log_paths.at(logs.size())}, {"first_index", part.first}});
  }
  return {{"record", "run"},
          {"format", "shapemap-trace"},
          {"format_version", 1},
          {"shapemap", kVersion},
          {"log", run.log_paths.at(0)},
          {"logs", logs},
          {"log_format", run.log.format},
          {"num_positions", run.log.scans.size()},
          {"histogram_scale", kHistogramScale},
          {"options", options}};
}

Json scan_json(const TracedRun& run, std::size_t scan_index, const std::vector<ShapePoint>& points) {
  const Scan& scan = run.log.scans.at(scan_index);
  const std::size_t log = part_with(run.log, scan_index);
  const std::size_t first = log == 0 ? 0 : run.log.starts[log - 1];
  Json sweeps = Json::array();
  for (std::size_t s = 0; s < scan.sweeps.size(); ++s) {
    sweeps.push_back(polylines_json(scan.sweeps[s], static_cast<int>(s), run.mapping));
  }
  Json shape = Json::array();
  for (const ShapePoint& p : points) {
    shape.push_back(Json::array({p.p_m.x(), p.p_m.y(), p.tangent_rad, p.sweep}));
  }
  Json all = {{"record", "position"},
              {"index", scan_index},
              {"log", log},
              {"index_in_whole_log", index_in_whole_log(scan_index - first, run.selection)},
              {"timestamp_s", number_json(scan.timestamp_s)},
              {"sub_scans", sweeps},
              {"points", shape}};
  if (run.mapping.run.method == Method::kPaper) {
    all["histograms"] = histograms_json(points, run.mapping.paper.histogram);
  }
  return all;
}

Json alignment_json(const TracedAlignment& traced, LcsTarget target) {
  const PaperAlignment& result = traced.alignment;
  Json rotations = Json::array();
  for (const RotationMatch& rotation : traced.steps.rotations) rotations.push_back(rotation_json(rotation));
  Json all = {{"record", "alignment"},       {"reference", traced.targets.back().scan_index},
              {"query", traced.query_index}, {"status", enum_name(result.status)},
              {"reason", result.reason},     {"targets", targets_json(traced.targets)},
              {"rotations", rotations}};
  add_best_rotation(traced, target, all);
  all["shape_ref_from_query"] = pose_array(result.shape_ref_from_query);
  all["icp_steps"] = pose_arrays(traced.steps.icp.steps);
  all["icp_ref_from_query"] = pose_array(result.icp_ref_from_query);
  all["query_from_sub_scan"] = pose_arrays(result.query_from_sweep);
  all["overlap"] = result.overlap;
  all["overlap_ratio"] = result.overlap_ratio;
  return all;
}

Json edge_json(const EdgeFound& edge) {
  return {{"record", "link"},
          {"reference", edge.reference_index},
          {"query", edge.query_index},
          {"num_own", edge.num_own},
          {"view_shortfall", edge.insufficient_view},
          {"hypotheses", candidates_json(edge.candidates)}};
}

Json choice_json(const EdgeChosen& choice) {
  return {{"record", "choice"},
          {"reference", choice.reference_index},
          {"query", choice.query_index},
          {"alternative", choice.candidate},
          {"margin", choice.margin}};
}

Json revision_json(const EdgeVerified& revision) {
  Json candidates = candidates_json(revision.candidates);
  for (std::size_t k = 0; k < revision.support_by_others.size(); ++k) {
    candidates[k]["for_it"] = revision.support_by_others[k].for_it;
    candidates[k]["against_it"] = revision.support_by_others[k].against_it;
    candidates[k]["vouched"] = revision.parallel_support[k];
  }
  return {{"record", "revision"},
          {"reference", revision.reference_index},
          {"query", revision.query_index},
          {"hypotheses", candidates},
          {"in_map", revision.in_map},
          {"alternative", revision.candidate},
          {"probability", revision.probability}};
}

Json result_json(const ScanResult& scan, const PlacedScan* placed) {
  return {{"record", "result"},
          {"index", scan.scan_index},
          {"timestamp_s", number_json(scan.timestamp_s)},
          {"fragment", scan.component},
          {"starts_fragment", scan.starts_component},
          {"status", scan.was_aligned() ? Json(scan.status_text()) : Json(nullptr)},
          {"reason", scan.reason},
          {"ref_from_query", scan.has_pose() ? pose_array(scan.ref_from_query()) : Json(nullptr)},
          {"probability", number_json(scan.match.probability)},
          {"covariance", covariance_json(scan.match.covariance)},
          {"fragment_from_robot", placed ? pose_array(placed->map_from_robot) : Json(nullptr)},
          {"robot_from_sub_scan", placed ? pose_arrays(placed->robot_from_sweep) : Json::array()}};
}

Json end_json(const MapResult& result) {
  return {{"record", "end"},
          {"num_positions", result.scans.size()},
          {"num_placed", result.placed().size()},
          {"largest_fragment", result.largest_component}};
}

}  // namespace shapemap
