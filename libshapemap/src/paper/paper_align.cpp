// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/paper_align.hpp"

#include <atomic>
#include <cmath>
#include <sstream>
#include <thread>

#include "shapemap/core/errors.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/core/stopwatch.hpp"
#include "shapemap/paper/lcs.hpp"

namespace shapemap {
namespace {

/// The target, which is the same for all rotations of the query, ready to be compared with.
struct MatchTarget {
  const PartialMap& map;
  std::vector<SimilarityIndex> indices;  ///< one per sequence
};

MatchTarget match_target(const PartialMap& map, const PaperOptions& options) {
  MatchTarget target{map, {}};
  for (const TargetScan& sequence : map.sequences()) {
    ScanFeatures features;
    for (const ShapePoint& point : sequence.shape.points)
      features.tangents_rad.push_back(wrap_angle(point.tangent_rad));
    features.histograms = sequence.directions->histograms(sequence.turned_rad, options.histogram.norm);
    target.indices.emplace_back(features, options.similarity);
  }
  return target;
}

/// Takes the paper's steps for one rotation: LCS, collinear filter, segment filter, segment-wise translation and scan
/// overlap measure.
RotationMatch match_at_rotation(const MatchTarget& target, const Shape& query, const NeighbourDirections& directions,
                                double rotation_rad, const PaperOptions& options) {
  RotationMatch match;
  match.rotation_rad = rotation_rad;
  const Shape turned = moved(query, {0.0, 0.0, rotation_rad});
  const ScanFeatures features = features_of(query, directions, rotation_rad, options.histogram.norm);
  for (std::size_t s = 0; s < target.indices.size(); ++s) {
    const std::vector<IndexPair> pairs = longest_common_subsequence(target.indices[s].matches(features));
    const Correspondences found = correspondences_of(pairs, turned, target.map.sequences()[s].shape, s);
    match.lcs.insert(match.lcs.end(), found.begin(), found.end());
  }
  match.spread = collinear_filter(match.lcs, options.filters);
  for (Segments& segments : segment_filter(cut_into_segments(match.spread, options.filters), options.filters)) {
    const SegmentTranslation translation = segment_wise_translation(segments);
    const Pose2 target_from_query{translation.target_from_query_m.x(), translation.target_from_query_m.y(),
                                  rotation_rad};
    const double limit_m = translation.mean_distance_m + options.overlap.slack_m;
    const bool is_first = match.translation.num_correspondences == 0;
    const std::size_t to_win = is_first ? 0 : static_cast<std::size_t>(match.overlap.num_points) + 1;
    const ScanOverlap overlap =
        scan_overlap(partners_within(target.map, query, target_from_query, {limit_m, to_win}, options.overlap));
    if (static_cast<std::size_t>(overlap.num_points) < to_win) continue;
    match.segments = std::move(segments);
    match.translation = translation;
    match.overlap = overlap;
  }
  return match;
}

/// Asks whether to go on from the thread that aligns only, and tells all threads the answer.
class StopCheck {
 public:
  explicit StopCheck(const std::function<bool()>& keep_going) : keep_going_(keep_going) {}

  bool stopped() {
    if (keep_going_ && !stopped_ && std::this_thread::get_id() == asking_ && !keep_going_()) stopped_ = true;
    return stopped_;
  }
  void throw_if_stopped() {
    if (stopped()) throw Interrupted();
  }

 private:
  const std::function<bool()>& keep_going_;
  std::thread::id asking_ = std::this_thread::get_id();
  std::atomic<bool> stopped_{false};
};

/// What rotations are shared among, and what ends them.
struct Threads {
  int count;
  StopCheck& stop;
};

/// Every rotation of the grid, each by itself. The hypotheses of all rotations need much memory.
std::vector<RotationMatch> match_rotations(const MatchTarget& target, const Shape& query, const PaperOptions& options,
                                           bool keep_hypotheses, Threads threads) {
  const NeighbourDirections directions(query, options.histogram.radius_m);
  const std::vector<double> rotations = rotation_grid(options.rotation);
  std::vector<RotationMatch> matches(rotations.size());
  parallel_for(rotations.size(), threads.count, [&](std::size_t i) {
    if (threads.stop.stopped()) return;
    matches[i] = match_at_rotation(target, query, directions, rotations[i], options);
    if (!keep_hypotheses) matches[i].lcs = matches[i].spread = {};
  });
  threads.stop.throw_if_stopped();
  return matches;
}

/// Returns the rotation with the largest scan overlap; of equals, the smallest turn. -1 when no rotation had a
/// correspondence.
int best_rotation(const std::vector<RotationMatch>& matches) {
  int best = -1;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (matches[i].translation.num_correspondences == 0) continue;
    const RotationMatch* leader = best < 0 ? nullptr : &matches[static_cast<std::size_t>(best)];
    const bool better = !leader || matches[i].overlap.num_points > leader->overlap.num_points ||
                        (matches[i].overlap.num_points == leader->overlap.num_points &&
                         std::abs(matches[i].rotation_rad) < std::abs(leader->rotation_rad));
    if (better) best = static_cast<int>(i);
  }
  return best;
}

PaperAlignment refused(PaperAlignment alignment, PaperStatus status, const std::string& reason) {
  alignment.status = status;
  alignment.reason = reason;
  alignment.ref_from_query = kNoPose;
  return alignment;
}

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

/// Gives the verdict on a finished alignment.
PaperAlignment judged(PaperAlignment alignment, const TrustOptions& trust) {
  if (alignment.num_correspondences < trust.min_correspondences) {
    const std::string reason =
        text("only ", alignment.num_correspondences, " correspondences support the best translation, ",
             trust.min_correspondences, " are needed");
    return refused(std::move(alignment), PaperStatus::kTooFewCorrespondences, reason);
  }
  if (alignment.overlap_ratio < trust.min_overlap_ratio) {
    const std::string reason = text("the aligned scan overlaps in ", alignment.overlap, " points, a share of ",
                                    alignment.overlap_ratio, ", ", trust.min_overlap_ratio, " is needed");
    return refused(std::move(alignment), PaperStatus::kTooLittleOverlap, reason);
  }
  alignment.status = PaperStatus::kOk;
  return alignment;
}

}  // namespace

std::vector<double> rotation_grid(const RotationOptions& options) {
  const auto steps = static_cast<int>(std::floor(options.range_rad / options.step_rad + 1e-9));
  std::vector<double> rotations;
  for (int k = -steps; k <= steps; ++k) {
    const double rotation_rad = k * options.step_rad;
    const bool again = !rotations.empty() && rotation_rad - rotations.front() > 2 * kPi - 1e-9;
    if (!again) rotations.push_back(rotation_rad);
  }
  return rotations;
}

PaperAlignment paper_align(const PartialMap& target, const Shape& query, const PaperOptions& options,
                           const PaperRun& run, PaperTrace* trace) {
  PaperAlignment result;
  Stopwatch watch;
  StopCheck stop(run.keep_going);
  if (trace) *trace = {};  // of an earlier alignment
  const auto min_points = static_cast<std::size_t>(run.min_points);
  if (target.num_points() < min_points || query.size() < min_points) {
    return refused(std::move(result), PaperStatus::kNoShape,
                   text("the scan has ", query.size(), " shape points and its target ", target.num_points(), ", ",
                        run.min_points, " are needed"));
  }

  // The rotation with the largest scan overlap wins. Only a trace wants to see the hypotheses.
  const std::vector<RotationMatch> matches =
      match_rotations(match_target(target, options), query, options, trace != nullptr, {run.threads, stop});
  const int best = best_rotation(matches);
  result.match_s = watch.lap_s();
  if (trace) {
    trace->rotations = matches;
    trace->best_rotation = best;
  }
  if (best < 0) {
    return refused(std::move(result), PaperStatus::kNoCorrespondences, "no similar structure was found");
  }
  const RotationMatch& match = matches[static_cast<std::size_t>(best)];
  result.rotation_rad = match.rotation_rad;
  result.num_correspondences = match.translation.num_correspondences;
  result.mean_distance_m = match.translation.mean_distance_m;
  result.shape_ref_from_query = match.target_from_query();

  // ICP runs on the complete scan and then on each of its sweeps.
  IcpResult refined =
      icp(target, query, {match.target_from_query(), result.mean_distance_m}, options.icp, options.overlap);
  result.ref_from_query = result.icp_ref_from_query = refined.target_from_query;
  result.overlap = refined.overlap.num_points;
  result.overlap_ratio = static_cast<double>(result.overlap) / static_cast<double>(query.size());
  result.icp_iterations = refined.iterations;
  result.icp_s = watch.lap_s();
  stop.throw_if_stopped();
  result.query_from_sweep.resize(static_cast<std::size_t>(query.num_sweeps));
  if (options.icp.decoupled) {
    const IcpStart start{refined.target_from_query, refined.overlap.mean_distance_m};
    result.query_from_sweep = decoupled_icp(target, query, start, options.icp, options.overlap);
  }
  result.decoupled_icp_s = watch.lap_s();
  if (trace) trace->icp = std::move(refined);
  return judged(std::move(result), options.trust);
}

PaperAlignment paper_align(const Shape& reference, const Shape& query, const PaperOptions& options, const PaperRun& run,
                           PaperTrace* trace) {
  const bool as_one_sequence = options.lcs.target == LcsTarget::kConcatenated;
  return paper_align(PartialMap({reference}, as_one_sequence, options.histogram.radius_m), query, options, run, trace);
}

}  // namespace shapemap
