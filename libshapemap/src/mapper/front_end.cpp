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
constexpr double kCompanionSlack = 1.3;

/// Of each scan further back, so many hypotheses are asked.
constexpr std::size_t kBorrowed = 2;

/// How well a pose goes with a scan that it was not made from. Little overlap says little either way.
double companion_score(const Visibility& v) {
  const double total = std::max(v.total(), 1e-9);
  return 3.0 * std::log(0.2 + v.agree / total) - 1.5 * std::log(0.1 + v.crossed / total);
}

bool more_likely(const PoseHypothesis& a, const PoseHypothesis& b) { return a.score > b.score; }

}  // namespace

FrontEnd::FrontEnd(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink,
                   AlignmentStore* store, MapResult& result)
    : log_(log),
      options_(options),
      observer_(observer),
      sink_(sink),
      store_(store),
      result_(result),
      tracker_(options.robust) {}

bool FrontEnd::extend(std::size_t most_keyframes) {
  observer_.on_stage("chain");
  const auto is_whole = [&] { return next_ == log_.positions.size() || !observer_.keep_going(); };
  while (!is_whole() && chain_.keyframes.size() < most_keyframes) {
    const std::size_t last = std::min(next_ + kBlock, log_.positions.size());
    const std::size_t first_new = chain_.keyframes.size();
    view_positions(next_, last);
    link_keyframes(first_new);
    next_ = last;
    observer_.on_progress(next_, log_.positions.size());
  }
  choose_hypotheses(chain_);
  expect_the_usual();
  choose_hypotheses(chain_);
  if (!options_.robust.loops.close_loops) let_views_go();
  return !is_whole();
}

/// But for those of the last keyframes, which the next are aligned to.
void FrontEnd::let_views_go() {
  const std::size_t needed = static_cast<std::size_t>(options_.robust.front_end.more_references) + 2;
  for (std::size_t i = 0; i + needed < chain_.keyframes.size(); ++i) chain_.keyframes[i].view.reset();
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
void FrontEnd::view_positions(std::size_t first, std::size_t last) {
  std::vector<Keyframe> scans(last - first);
  result_.times.shape_s += timed_for(last - first, [&](std::size_t i) { scans[i] = viewed(first + i); });
  for (std::size_t i = first; i < last; ++i) {
    Keyframe& scan = scans[i - first];
    const std::size_t num_points = scan.view->size();
    if (sink_) sink_->on_shape(i, scan.view->points);
    PositionResult outcome;
    outcome.position_index = i;
    outcome.timestamp_s = log_.positions[i].timestamp_s;
    outcome.session = scan.session;
    if (num_points >= static_cast<std::size_t>(options_.shape.min_points)) {
      take(std::move(scan));
    } else {
      outcome.alignment.status = AlignStatus::kNoShape;
      outcome.reason = "only " + std::to_string(num_points) + " shape points, " +
                       std::to_string(options_.shape.min_points) + " are needed";
    }
    result_.positions.push_back(std::move(outcome));
  }
}

Keyframe FrontEnd::viewed(std::size_t position_index) const {
  const auto view_of_sweeps = [&](const Position& sweeps) {
    return std::make_shared<ScanView>(
        view_of(sweeps, options_.returns, options_.polylines, options_.shape, options_.robust.matcher.view));
  };
  const Position& position = log_.positions[position_index];
  Keyframe scan;
  scan.position_index = position_index;
  scan.session = part_with(log_, position_index);
  scan.view = view_of_sweeps(position);
  if (position.sub_scans.size() == 1) return scan;
  for (const SubScan& sub_scan : position.sub_scans) {
    Position alone;
    alone.sub_scans = {sub_scan};
    scan.sweep_views.push_back(view_of_sweeps(alone));
  }
  return scan;
}

/// A scan with shape is attached to the last keyframe, or becomes one.
void FrontEnd::take(Keyframe scan) {
  if (!chain_.keyframes.empty() && scan.session != chain_.keyframes.back().session) tracker_.start(nullptr);
  if (scan.position_index > last_seen_ + 1) tracker_.forget_motion();
  last_seen_ = scan.position_index;
  const auto start = std::chrono::steady_clock::now();
  const std::optional<PoseHypothesis> pose = tracker_.follow(*scan.view);
  result_.times.align_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (pose) {
    chain_.attached.push_back({scan.position_index, chain_.keyframes.size() - 1, *pose});
    return;
  }
  scan.expected = tracker_.expected();
  tracker_.start(scan.view);
  chain_.keyframes.push_back(std::move(scan));
}

/// Whether another recording starts between the two keyframes of a link.
bool FrontEnd::starts_session(std::size_t link) const {
  return chain_.keyframes[link].session != chain_.keyframes[link + 1].session;
}

/// Links of the keyframes from `first_new` on, each to the one before it.
void FrontEnd::link_keyframes(std::size_t first_new) {
  const std::size_t first = std::max<std::size_t>(first_new, 1);
  if (chain_.keyframes.size() <= first) return;
  const std::size_t count = chain_.keyframes.size() - first;
  chain_.links.resize(chain_.keyframes.size() - 1);
  result_.times.align_s += timed_for(count, [&](std::size_t i) {
    const std::size_t link = first + i - 1;
    if (starts_session(link)) return;
    hypotheses(link) = aligned(link, link + 1, SearchKind::kFull, options_.robust.matcher.search);
  });
  std::vector<std::vector<PoseHypothesis>> borrowed(count);
  result_.times.align_s += timed_for(count, [&](std::size_t i) { borrowed[i] = borrow_hypotheses(first + i - 1); });
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t b = first + i;
    KeyframeLink& link = chain_.links[b - 1];
    link.num_own = link.hypotheses.size();
    for (const PoseHypothesis& pose : borrowed[i]) add_if_new(pose, link.hypotheses);
    if (chain_.keyframes[b].expected) {
      expect(*chain_.keyframes[b].expected, b - 1);
    } else {
      link.view_shortfall = view_shortfall(view_of_keyframe(b - 1), view_of_keyframe(b));
    }
  }
  result_.times.align_s += timed_for(count, [&](std::size_t i) {
    if (first + i >= 2) chain_.links[first + i - 2].bonus = companion_scores(first + i - 2);
  });
}

/// Where scans follow each other closely, hypotheses far from where the next was to be expected are less likely.
void FrontEnd::expect(const ExpectedPose& expected, std::size_t link) {
  std::vector<PoseHypothesis>& found = hypotheses(link);
  add_if_new(refined_hypothesis(view_of_keyframe(link), view_of_keyframe(link + 1), expected.pose,
                                options_.robust.matcher.search),
             found);
  for (PoseHypothesis& pose : found) pose.score -= surprise(expected, pose.ref_from_query);
  std::stable_sort(found.begin(), found.end(), more_likely);
}

/// Once it is known how the sensor usually moves, what is unusual scores less, and links that are then in doubt are
/// looked into again. Where the motion was followed, more is known than that.
void FrontEnd::expect_the_usual() {
  const MotionHabit habit = motion_habit(chain_);
  std::vector<std::size_t> links;
  std::vector<std::size_t> unusual;
  for (std::size_t i = 0; i < chain_.links.size(); ++i) {
    const KeyframeLink& link = chain_.links[i];
    if (link.is_complete || link.settled_covariance) continue;
    links.push_back(i);
    if (!link.hypotheses.empty() && !chain_.keyframes[i + 1].expected) unusual.push_back(i);
  }
  result_.times.align_s += timed_for(unusual.size(), [&](std::size_t k) { expect_the_usual(habit, unusual[k]); });
  std::set<std::size_t> pairs;  // of a link and the next, of which one has changed
  for (const std::size_t i : unusual) {
    if (i > 0) pairs.insert(i - 1);
    if (i + 1 < chain_.links.size()) pairs.insert(i);
  }
  const std::vector<std::size_t> changed(pairs.begin(), pairs.end());
  result_.times.align_s +=
      timed_for(changed.size(), [&](std::size_t k) { chain_.links[changed[k]].bonus = companion_scores(changed[k]); });
  for (const std::size_t i : links) {
    KeyframeLink& link = chain_.links[i];
    link.is_complete = true;
    if (sink_ && !link.hypotheses.empty()) {
      sink_->on_link({position_of(i), position_of(i + 1), link.hypotheses, link.num_own, link.view_shortfall});
    }
  }
}

void FrontEnd::expect_the_usual(const MotionHabit& habit, std::size_t link) {
  const HypothesisSearchOptions& search = options_.robust.matcher.search;
  std::vector<PoseHypothesis>& known = hypotheses(link);
  for (PoseHypothesis& pose : known) pose.score -= habit.surprise(pose.ref_from_query);
  std::stable_sort(known.begin(), known.end(), more_likely);
  if (match_probability(known.front(), lead_of_first(known)) < options_.robust.map_search.doubt_below) {
    const auto more = usual_hypotheses(view_of_keyframe(link), view_of_keyframe(link + 1), search, habit);
    known.insert(known.end(), more.begin(), more.end());
    known = best_distinct(std::move(known), search.hypotheses.kept);
  }
  chain_.links[link].num_own = known.size();
}

std::vector<PoseHypothesis> FrontEnd::aligned(std::size_t reference, std::size_t query, SearchKind search,
                                              const HypothesisSearchOptions& options) const {
  return pose_hypotheses(view_of_keyframe(reference), view_of_keyframe(query), options,
                         {position_of(reference), position_of(query), search}, store_);
}

/// When a link is in doubt: what scans further back say about it, by way of the best links between.
std::vector<PoseHypothesis> FrontEnd::borrow_hypotheses(std::size_t link) const {
  std::vector<PoseHypothesis> borrowed;
  if (starts_session(link) || !in_doubt(hypotheses(link))) return borrowed;
  HypothesisSearchOptions quick = options_.robust.matcher.search;
  quick.hypotheses.all_rotations_below = -std::numeric_limits<double>::infinity();
  const ScanView& reference = view_of_keyframe(link);
  const ScanView& query = view_of_keyframe(link + 1);
  const double limit_m = max_shift_m(reference, query, options_.robust.matcher.search.voting);
  Pose2 far_from_reference;
  for (std::size_t back = 1; back <= static_cast<std::size_t>(options_.robust.front_end.more_references); ++back) {
    if (link < back || hypotheses(link - back).empty()) break;
    far_from_reference = hypotheses(link - back).front().ref_from_query * far_from_reference;
    const std::vector<PoseHypothesis> seen_from_far = aligned(link - back, link + 1, SearchKind::kBorrowed, quick);
    for (std::size_t k = 0; k < std::min(kBorrowed, seen_from_far.size()); ++k) {
      const Pose2 ref_from_query = inverse(far_from_reference) * seen_from_far[k].ref_from_query;
      if (ref_from_query.translation().lpNorm<Eigen::Infinity>() > limit_m) continue;
      borrowed.push_back(refined_hypothesis(reference, query, ref_from_query, options_.robust.matcher.search));
    }
  }
  return borrowed;
}

bool FrontEnd::in_doubt(const std::vector<PoseHypothesis>& link) const {
  return link.empty() || match_probability(link.front(), lead_of_first(link)) < options_.robust.front_end.doubt_below;
}

/// For each pair of alternatives of a link and the next: how the far scan then goes with the near one.
std::vector<std::vector<double>> FrontEnd::companion_scores(std::size_t link) const {
  std::vector<std::vector<double>> scores = no_bonus(chain_.links[link], chain_.links[link + 1]);
  for (std::size_t a = 0; a < hypotheses(link).size(); ++a) {
    for (std::size_t b = 0; b < hypotheses(link + 1).size(); ++b) {
      const Pose2 near_from_far = hypotheses(link)[a].ref_from_query * hypotheses(link + 1)[b].ref_from_query;
      scores[a][b] = options_.robust.front_end.companion_weight *
                     companion_score(visibility(view_of_keyframe(link), view_of_keyframe(link + 2), near_from_far,
                                                options_.robust.matcher.search.visibility, kCompanionSlack));
    }
  }
  return scores;
}

}  // namespace shapemap
