// SPDX-License-Identifier: GPL-3.0-or-later
#include "front_end.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <set>

#include "shapemap/core/parallel_for.hpp"
#include "shapemap/matching/scan_matcher.hpp"
#include "shapemap/scan/joined_logs.hpp"

namespace shapemap {
namespace {

/// Positions that are worked on together, and between which the observer is asked. Part of no result.
constexpr std::size_t kBlock = 32;

/// Two steps of the chain put a scan less exactly than one: distances are taken this much wider.
constexpr double kThreeScanSlack = 1.3;

/// Of each scan further back, so many hypotheses are asked.
constexpr std::size_t kMultiReference = 2;

/// How well a pose goes with a scan that it was not made from. Little overlap says little either way.
double three_scan_score(const Visibility& v) {
  const double total = std::max(v.total(), 1e-9);
  return 3.0 * std::log(0.2 + v.agree / total) - 1.5 * std::log(0.1 + v.crossed / total);
}

bool more_likely(const MatchCandidate& a, const MatchCandidate& b) { return a.score > b.score; }

}  // namespace

FrontEnd::FrontEnd(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink,
                   MatchCache* store, MapResult& result)
    : log_(log),
      options_(options),
      observer_(observer),
      sink_(sink),
      store_(store),
      result_(result),
      tracker_(options.robust) {}

bool FrontEnd::extend(std::size_t most_keyframes) {
  observer_.on_stage("chain");
  const auto is_whole = [&] { return next_ == log_.scans.size() || !observer_.keep_going(); };
  while (!is_whole() && graph_.keyframes.size() < most_keyframes) {
    const std::size_t last = std::min(next_ + kBlock, log_.scans.size());
    const std::size_t first_new = graph_.keyframes.size();
    view_scans(next_, last);
    link_keyframes(first_new);
    next_ = last;
    observer_.on_progress(next_, log_.scans.size());
  }
  choose_candidates(graph_);
  expect_the_usual();
  choose_candidates(graph_);
  if (!options_.robust.loops.close_loops) let_views_go();
  return !is_whole();
}

/// But for those of the last keyframes, which the next are aligned to.
void FrontEnd::let_views_go() {
  const std::size_t needed = static_cast<std::size_t>(options_.robust.front_end.more_references) + 2;
  for (std::size_t i = 0; i + needed < graph_.keyframes.size(); ++i) graph_.keyframes[i].view.reset();
}

/// parallel_for(); the seconds that `work` took, summed over the threads.
double FrontEnd::timed_for(std::size_t count, const std::function<void(std::size_t)>& work) const {
  std::vector<double> seconds(count, 0.0);
  parallel_for(count, options_.run.threads, [&](std::size_t i) {
    const auto start = std::chrono::steady_clock::now();
    work(i);
    seconds[i] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  });
  return std::accumulate(seconds.begin(), seconds.end(), 0.0);
}

/// Views of the positions [first, last), and an entry of the result for each.
void FrontEnd::view_scans(std::size_t first, std::size_t last) {
  std::vector<Keyframe> scans(last - first);
  result_.times.shape_s += timed_for(last - first, [&](std::size_t i) { scans[i] = viewed(first + i); });
  for (std::size_t i = first; i < last; ++i) {
    Keyframe& scan = scans[i - first];
    const std::size_t num_points = scan.view->size();
    if (sink_) sink_->on_shape(i, scan.view->points);
    ScanResult outcome;
    outcome.scan_index = i;
    outcome.timestamp_s = log_.scans[i].timestamp_s;
    outcome.session = scan.session;
    if (num_points >= static_cast<std::size_t>(options_.shape.min_points)) {
      take(std::move(scan));
    } else {
      outcome.match.status = MatchStatus::kNoShape;
      outcome.reason = "only " + std::to_string(num_points) + " shape points, " +
                       std::to_string(options_.shape.min_points) + " are needed";
    }
    result_.scans.push_back(std::move(outcome));
  }
}

Keyframe FrontEnd::viewed(std::size_t scan_index) const {
  const auto view_of_sweeps = [&](const Scan& sweeps) {
    return std::make_shared<ScanView>(
        view_of(sweeps, options_.returns, options_.polylines, options_.shape, options_.robust.matcher.view));
  };
  const Scan& scan = log_.scans[scan_index];
  Keyframe viewed;
  viewed.scan_index = scan_index;
  viewed.session = part_with(log_, scan_index);
  viewed.view = view_of_sweeps(scan);
  if (scan.sweeps.size() == 1) return viewed;
  for (const Sweep& sweep : scan.sweeps) {
    Scan alone;
    alone.sweeps = {sweep};
    viewed.sweep_views.push_back(view_of_sweeps(alone));
  }
  return viewed;
}

/// A scan with shape is attached to the last keyframe, or becomes one.
void FrontEnd::take(Keyframe scan) {
  if (!graph_.keyframes.empty() && scan.session != graph_.keyframes.back().session) tracker_.start(nullptr);
  if (scan.scan_index > last_seen_ + 1) tracker_.forget_motion();
  last_seen_ = scan.scan_index;
  const auto start = std::chrono::steady_clock::now();
  const std::optional<MatchCandidate> pose = tracker_.follow(*scan.view);
  result_.times.align_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (pose) {
    graph_.attached.push_back({scan.scan_index, graph_.keyframes.size() - 1, *pose});
    return;
  }
  scan.expected = tracker_.expected();
  tracker_.start(scan.view);
  graph_.keyframes.push_back(std::move(scan));
}

/// Whether another recording starts between the two keyframes of a link.
bool FrontEnd::starts_session(std::size_t edge) const {
  return graph_.keyframes[edge].session != graph_.keyframes[edge + 1].session;
}

/// Links of the keyframes from `first_new` on, each to the one before it.
void FrontEnd::link_keyframes(std::size_t first_new) {
  const std::size_t first = std::max<std::size_t>(first_new, 1);
  if (graph_.keyframes.size() <= first) return;
  const std::size_t count = graph_.keyframes.size() - first;
  graph_.edges.resize(graph_.keyframes.size() - 1);
  result_.times.align_s += timed_for(count, [&](std::size_t i) {
    const std::size_t edge = first + i - 1;
    if (starts_session(edge)) return;
    candidates(edge) = aligned(edge, edge + 1, SearchKind::kFull, options_.robust.matcher.search);
  });
  std::vector<std::vector<MatchCandidate>> multi_reference(count);
  result_.times.align_s +=
      timed_for(count, [&](std::size_t i) { multi_reference[i] = multi_reference_candidates(first + i - 1); });
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t b = first + i;
    OdometryEdge& edge = graph_.edges[b - 1];
    edge.num_own = edge.candidates.size();
    for (const MatchCandidate& pose : multi_reference[i]) add_if_new(pose, edge.candidates);
    if (graph_.keyframes[b].expected) {
      expect(*graph_.keyframes[b].expected, b - 1);
    } else {
      edge.insufficient_view = insufficient_view(view_of_keyframe(b - 1), view_of_keyframe(b));
    }
  }
  result_.times.align_s += timed_for(count, [&](std::size_t i) {
    if (first + i >= 2) graph_.edges[first + i - 2].transition_scores = three_scan_scores(first + i - 2);
  });
}

/// Where scans follow each other closely, hypotheses far from where the next was to be expected are less likely.
void FrontEnd::expect(const ExpectedPose& expected, std::size_t edge) {
  std::vector<MatchCandidate>& found = candidates(edge);
  add_if_new(refined_candidate(view_of_keyframe(edge), view_of_keyframe(edge + 1), expected.pose,
                               options_.robust.matcher.search),
             found);
  for (MatchCandidate& pose : found) pose.score -= surprise(expected, pose.ref_from_query);
  std::stable_sort(found.begin(), found.end(), more_likely);
}

/// Once it is known how the sensor usually moves, what is unusual scores less, and links that are then in doubt are
/// looked into again. Where the motion was followed, more is known than that.
void FrontEnd::expect_the_usual() {
  const MotionPrior prior = motion_prior(graph_);
  std::vector<std::size_t> edges;
  std::vector<std::size_t> unusual;
  for (std::size_t i = 0; i < graph_.edges.size(); ++i) {
    const OdometryEdge& edge = graph_.edges[i];
    if (edge.is_complete || edge.culled_covariance) continue;
    edges.push_back(i);
    if (!edge.candidates.empty() && !graph_.keyframes[i + 1].expected) unusual.push_back(i);
  }
  result_.times.align_s += timed_for(unusual.size(), [&](std::size_t k) { expect_the_usual(prior, unusual[k]); });
  std::set<std::size_t> pairs;  // of a link and the next, of which one has changed
  for (const std::size_t i : unusual) {
    if (i > 0) pairs.insert(i - 1);
    if (i + 1 < graph_.edges.size()) pairs.insert(i);
  }
  const std::vector<std::size_t> changed(pairs.begin(), pairs.end());
  result_.times.align_s += timed_for(changed.size(), [&](std::size_t k) {
    graph_.edges[changed[k]].transition_scores = three_scan_scores(changed[k]);
  });
  for (const std::size_t i : edges) {
    OdometryEdge& edge = graph_.edges[i];
    edge.is_complete = true;
    if (sink_ && !edge.candidates.empty()) {
      sink_->on_link(
          {scan_of_keyframe(i), scan_of_keyframe(i + 1), edge.candidates, edge.num_own, edge.insufficient_view});
    }
  }
}

void FrontEnd::expect_the_usual(const MotionPrior& prior, std::size_t edge) {
  const MatchSearchOptions& search = options_.robust.matcher.search;
  std::vector<MatchCandidate>& known = candidates(edge);
  for (MatchCandidate& pose : known) pose.score -= prior.surprise(pose.ref_from_query);
  std::stable_sort(known.begin(), known.end(), more_likely);
  if (match_probability(known.front(), lead_of_first(known)) < options_.robust.map_search.doubt_below) {
    const auto more = find_usual_candidates(view_of_keyframe(edge), view_of_keyframe(edge + 1), search, prior);
    known.insert(known.end(), more.begin(), more.end());
    known = best_distinct(std::move(known), search.candidates.kept);
  }
  graph_.edges[edge].num_own = known.size();
}

std::vector<MatchCandidate> FrontEnd::aligned(std::size_t reference, std::size_t query, SearchKind search,
                                              const MatchSearchOptions& options) const {
  return find_candidates(view_of_keyframe(reference), view_of_keyframe(query), options,
                         {scan_of_keyframe(reference), scan_of_keyframe(query), search}, store_);
}

/// When a link is in doubt: what scans further back say about it, by way of the best links between.
std::vector<MatchCandidate> FrontEnd::multi_reference_candidates(std::size_t edge) const {
  std::vector<MatchCandidate> multi_reference;
  if (starts_session(edge) || !in_doubt(candidates(edge))) return multi_reference;
  MatchSearchOptions quick = options_.robust.matcher.search;
  quick.candidates.all_rotations_below = -std::numeric_limits<double>::infinity();
  const ScanView& reference = view_of_keyframe(edge);
  const ScanView& query = view_of_keyframe(edge + 1);
  const double limit_m = max_shift_m(reference, query, options_.robust.matcher.search.voting);
  Pose2 far_from_reference;
  for (std::size_t back = 1; back <= static_cast<std::size_t>(options_.robust.front_end.more_references); ++back) {
    if (edge < back || candidates(edge - back).empty()) break;
    far_from_reference = candidates(edge - back).front().ref_from_query * far_from_reference;
    const std::vector<MatchCandidate> seen_from_far =
        aligned(edge - back, edge + 1, SearchKind::kMultiReference, quick);
    for (std::size_t k = 0; k < std::min(kMultiReference, seen_from_far.size()); ++k) {
      const Pose2 ref_from_query = inverse(far_from_reference) * seen_from_far[k].ref_from_query;
      if (ref_from_query.translation().lpNorm<Eigen::Infinity>() > limit_m) continue;
      multi_reference.push_back(refined_candidate(reference, query, ref_from_query, options_.robust.matcher.search));
    }
  }
  return multi_reference;
}

bool FrontEnd::in_doubt(const std::vector<MatchCandidate>& edge) const {
  return edge.empty() || match_probability(edge.front(), lead_of_first(edge)) < options_.robust.front_end.doubt_below;
}

/// For each pair of alternatives of a link and the next: how the far scan then goes with the near one.
std::vector<std::vector<double>> FrontEnd::three_scan_scores(std::size_t edge) const {
  std::vector<std::vector<double>> scores = no_transition_scores(graph_.edges[edge], graph_.edges[edge + 1]);
  for (std::size_t a = 0; a < candidates(edge).size(); ++a) {
    for (std::size_t b = 0; b < candidates(edge + 1).size(); ++b) {
      const Pose2 near_from_far = candidates(edge)[a].ref_from_query * candidates(edge + 1)[b].ref_from_query;
      scores[a][b] = options_.robust.front_end.three_scan_weight *
                     three_scan_score(visibility(view_of_keyframe(edge), view_of_keyframe(edge + 2), near_from_far,
                                                 options_.robust.matcher.search.visibility, kThreeScanSlack));
    }
  }
  return scores;
}

}  // namespace shapemap
