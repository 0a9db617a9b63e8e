// SPDX-License-Identifier: GPL-3.0-or-later
#include "front_end.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "mapper_numbers.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/core/stopwatch.hpp"
#include "shapemap/matching/candidate_order.hpp"
#include "shapemap/matching/match_probability.hpp"

namespace shapemap {
namespace {

/// Where scans follow each other closely, candidates far from the expected pose are less likely.
void expect(const ExpectedPose& expected, const MatchCandidate& at_expected, std::vector<MatchCandidate>& candidates) {
  add_if_new(at_expected, candidates);
  for (MatchCandidate& candidate : candidates) candidate.score -= surprise(expected, candidate.ref_from_query);
  std::stable_sort(candidates.begin(), candidates.end(), is_more_likely);
}

}  // namespace

FrontEnd::FrontEnd(const MappingOptions& options, MatchCache* cache)
    : options_(options), cache_(cache), tracker_(options.robust) {}

std::vector<TrackedScan> FrontEnd::track(const std::vector<IncomingScan>& scans) {
  std::vector<TrackedScan> tracked(scans.size());
  shape_s_ += timed_for(scans.size(), [&](std::size_t i) { tracked[i] = viewed(scans[i], num_scans_ + i); });
  const std::size_t first_new = recent_.size();
  std::vector<NewKeyframe*> added;
  std::vector<const Scan*> added_scans;
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    track(tracked[i]);
    if (!tracked[i].keyframe) continue;
    added.push_back(&*tracked[i].keyframe);
    added_scans.push_back(&scans[i].scan);
  }
  num_scans_ += scans.size();
  shape_s_ += timed_for(added.size(),
                        [&](std::size_t i) { added[i]->keyframe.sweep_views = views_of_sweeps(*added_scans[i]); });
  add_edges(first_new, added);
  const std::size_t needed = static_cast<std::size_t>(options_.robust.front_end.more_references) + 2;
  const std::size_t left = std::min(needed, recent_.size());
  recent_.erase(recent_.begin(), recent_.end() - static_cast<std::ptrdiff_t>(left));
  return tracked;
}

/// Calls parallel_for(), and returns the seconds that `work` took, summed over the threads.
double FrontEnd::timed_for(std::size_t count, const std::function<void(std::size_t)>& work) const {
  std::vector<double> seconds(count, 0.0);
  parallel_for(count, options_.run.threads, [&](std::size_t i) {
    const Stopwatch watch;
    work(i);
    seconds[i] = watch.seconds();
  });
  return std::accumulate(seconds.begin(), seconds.end(), 0.0);
}

std::shared_ptr<const ScanView> FrontEnd::view(const Scan& scan) const {
  return std::make_shared<ScanView>(
      view_of(scan, options_.returns, options_.polylines, options_.shape, options_.robust.matcher.view));
}

TrackedScan FrontEnd::viewed(const IncomingScan& incoming, std::size_t scan_index) const {
  TrackedScan tracked;
  tracked.scan_index = scan_index;
  tracked.session = incoming.session;
  tracked.timestamp_s = incoming.scan.timestamp_s;
  tracked.num_sweeps = incoming.scan.sweeps.size();
  tracked.view = view(incoming.scan);
  if (tracked.view->size() < static_cast<std::size_t>(options_.shape.min_points)) return tracked;
  NewKeyframe& keyframe = tracked.keyframe.emplace();
  keyframe.keyframe.scan_index = scan_index;
  keyframe.keyframe.session = incoming.session;
  keyframe.keyframe.view = tracked.view;
  return tracked;
}

/// Returns no views where the scan has one sweep only.
std::vector<std::shared_ptr<const ScanView>> FrontEnd::views_of_sweeps(const Scan& scan) const {
  std::vector<std::shared_ptr<const ScanView>> views;
  if (scan.sweeps.size() == 1) return views;
  for (const Sweep& sweep : scan.sweeps) {
    Scan alone;
    alone.sweeps = {sweep};
    views.push_back(view(alone));
  }
  return views;
}

/// A scan with shape becomes a keyframe unless the last one can replace it.
void FrontEnd::track(TrackedScan& scan) {
  if (!scan.keyframe) return;
  if (!recent_.empty() && scan.session != recent_.back().session) tracker_.start(nullptr);
  if (scan.scan_index > last_with_shape_ + 1) tracker_.forget_motion();
  last_with_shape_ = scan.scan_index;
  const Stopwatch watch;
  scan.attached = tracker_.follow(*scan.view);
  match_s_ += watch.seconds();
  if (scan.attached) {
    scan.keyframe.reset();
    return;
  }
  scan.keyframe->keyframe.expected = tracker_.expected();
  tracker_.start(scan.view);
  recent_.push_back({scan.scan_index, scan.session, scan.view, {}, {}});
}

/// Adds the edges to the keyframes from number `first` of the recent ones on, each from the keyframe before.
void FrontEnd::add_edges(std::size_t first, std::vector<NewKeyframe*>& added) {
  match_s_ += timed_for(added.size(), [&](std::size_t i) {
    const std::size_t b = first + i;
    if (!has_edge(b)) return;
    recent_[b].candidates = matched(b - 1, b, SearchKind::kFull, options_.robust.matcher.search);
    if (!recent_[b].candidates.empty()) recent_[b].best_own = recent_[b].candidates.front().ref_from_query;
  });
  match_s_ += timed_for(added.size(), [&](std::size_t i) {
    if (first + i > 0) finish_edge(first + i, multi_reference_candidates(first + i), *added[i]);
  });
}

/// Returns whether a recent keyframe is of the same session as the one before it.
bool FrontEnd::has_edge(std::size_t recent) const {
  return recent > 0 && recent_[recent].session == recent_[recent - 1].session;
}

void FrontEnd::finish_edge(std::size_t recent, const std::vector<MatchCandidate>& multi_reference, NewKeyframe& added) {
  std::vector<MatchCandidate>& candidates = recent_[recent].candidates;
  OdometryEdge& edge = added.edge;
  const ScanView& reference = *recent_[recent - 1].view;
  const ScanView& query = *recent_[recent].view;
  edge.num_own = candidates.size();
  for (const MatchCandidate& candidate : multi_reference) add_if_new(candidate, candidates);
  if (const std::optional<ExpectedPose>& expected = added.keyframe.expected) {
    expect(*expected, refined_candidate(reference, query, expected->pose, options_.robust.matcher.search), candidates);
  } else {
    edge.insufficient_view = insufficient_view(reference, query);
  }
  edge.candidates = candidates;
}

std::vector<MatchCandidate> FrontEnd::matched(std::size_t reference, std::size_t query, SearchKind search,
                                              const MatchSearchOptions& options) const {
  const RecentKeyframe& a = recent_[reference];
  const RecentKeyframe& b = recent_[query];
  return find_candidates(*a.view, *b.view, options, {a.scan_index, b.scan_index, search}, cache_);
}

/// Matches the scan of a doubtful edge to keyframes further back, and composes these matches with the best poses of the
/// edges in between.
std::vector<MatchCandidate> FrontEnd::multi_reference_candidates(std::size_t recent) const {
  std::vector<MatchCandidate> found;
  const std::vector<MatchCandidate>& own = recent_[recent].candidates;
  const bool is_in_doubt =
      own.empty() || match_probability(own.front(), lead_of_first(own)) < options_.robust.front_end.doubt_below;
  if (!has_edge(recent) || !is_in_doubt) return found;
  MatchSearchOptions quick = options_.robust.matcher.search;
  quick.candidates.all_rotations_below = -std::numeric_limits<double>::infinity();
  const ScanView& reference = *recent_[recent - 1].view;
  const ScanView& query = *recent_[recent].view;
  const double limit_m = max_shift_m(reference, query, options_.robust.matcher.search.voting);
  Pose2 far_from_reference;
  const auto most = static_cast<std::size_t>(options_.robust.front_end.more_references);
  for (std::size_t far = recent - 1; far > 0 && recent - 1 - far < most; --far) {
    if (!recent_[far].best_own) break;
    far_from_reference = *recent_[far].best_own * far_from_reference;
    const std::vector<MatchCandidate> from_far = matched(far - 1, recent, SearchKind::kMultiReference, quick);
    for (std::size_t k = 0; k < std::min(kMapper.tracking.multi_reference_candidates, from_far.size()); ++k) {
      const Pose2 ref_from_query = inverse(far_from_reference) * from_far[k].ref_from_query;
      if (ref_from_query.translation().lpNorm<Eigen::Infinity>() > limit_m) continue;
      found.push_back(refined_candidate(reference, query, ref_from_query, options_.robust.matcher.search));
    }
  }
  return found;
}

}  // namespace shapemap
