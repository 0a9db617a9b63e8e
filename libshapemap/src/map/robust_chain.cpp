// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>

#include "chain_smoothing.hpp"
#include "chains.hpp"
#include "shapemap/align/robust_align.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/core/parallel_for.hpp"

namespace shapemap {
namespace {

/// Positions that are worked on together, and between which the observer is asked. Part of no result.
constexpr std::size_t kBlock = 32;

/// Two steps of the chain put a scan less exactly than one: distances are taken this much wider.
constexpr double kCompanionSlack = 1.3;

/// Of each scan further back, so many hypotheses are asked.
constexpr std::size_t kBorrowed = 2;

/// A scan with shape; the chain links each of them to the next.
struct ChainedScan {
  std::size_t position_index = 0;
  std::shared_ptr<const ScanView> view;  ///< dropped when no later scan needs it
};

/// How well a pose goes with a scan that it was not made from. Little overlap says little either way.
double companion_score(const Visibility& v) {
  const double total = std::max(v.total(), 1e-9);
  return 3.0 * std::log(0.2 + v.agree / total) - 1.5 * std::log(0.1 + v.crossed / total);
}

class RobustChain {
 public:
  RobustChain(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink, MapResult& result)
      : log_(log), options_(options), observer_(observer), sink_(sink), result_(result) {}

  void run() {
    for (std::size_t first = 0; first < log_.positions.size(); first += kBlock) {
      if (!observer_.keep_going()) {
        place(best_choices(choices_, kFullMargin));
        throw Interrupted();
      }
      const std::size_t last = std::min(first + kBlock, log_.positions.size());
      const std::size_t first_new = scans_.size();
      view_positions(first, last);
      link_scans(first_new);
      observer_.on_progress(last, log_.positions.size());
    }
    place(best_choices(choices_, kFullMargin));
  }

 private:
  /// parallel_for(); the seconds that `work` took, summed over the threads.
  double timed_for(std::size_t count, const std::function<void(std::size_t)>& work) const {
    std::vector<double> seconds(count, 0.0);
    parallel_for(count, options_.chain.threads, [&](std::size_t i) {
      const auto start = std::chrono::steady_clock::now();
      work(i);
      seconds[i] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    });
    return std::accumulate(seconds.begin(), seconds.end(), 0.0);
  }

  /// Views of the positions [first, last), and an entry of the result for each.
  void view_positions(std::size_t first, std::size_t last) {
    std::vector<std::shared_ptr<const ScanView>> views(last - first);
    result_.times.shape_s += timed_for(last - first, [&](std::size_t i) {
      views[i] = std::make_shared<ScanView>(view_of(log_.positions[first + i], options_.returns, options_.polylines,
                                                    options_.shape, options_.robust.view));
    });
    for (std::size_t i = first; i < last; ++i) {
      const std::shared_ptr<const ScanView>& view = views[i - first];
      if (sink_) sink_->on_shape(i, view->points);
      PositionResult outcome;
      outcome.position_index = i;
      outcome.timestamp_s = log_.positions[i].timestamp_s;
      if (view->size() >= static_cast<std::size_t>(options_.shape.min_points)) {
        scans_.push_back({i, view});
      } else {
        outcome.alignment.status = AlignStatus::kNoShape;
        outcome.reason = "only " + std::to_string(view->size()) + " shape points, " +
                         std::to_string(options_.shape.min_points) + " are needed";
      }
      result_.positions.push_back(std::move(outcome));
    }
  }

  /// Links of the scans from `first_new` on, each to the scan before it.
  void link_scans(std::size_t first_new) {
    const std::size_t first = std::max<std::size_t>(first_new, 1);
    if (scans_.size() <= first) return;
    const std::size_t count = scans_.size() - first;
    links_.resize(scans_.size() - 1);
    choices_.scores.resize(links_.size());
    choices_.bonus.resize(links_.size());
    // Link i goes from scan i to scan i + 1.
    result_.times.align_s += timed_for(count, [&](std::size_t i) {
      const std::size_t link = first + i - 1;
      links_[link] = pose_hypotheses(*scans_[link].view, *scans_[link + 1].view, options_.robust.search);
    });
    std::vector<std::vector<PoseHypothesis>> borrowed(count);
    result_.times.align_s += timed_for(count, [&](std::size_t i) { borrowed[i] = borrow_hypotheses(first + i - 1); });
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<PoseHypothesis>& link = links_[first + i - 1];
      const std::size_t num_own = link.size();
      for (const PoseHypothesis& pose : borrowed[i]) add_if_new(pose, link);
      const std::size_t reference = scans_[first + i - 1].position_index;
      if (sink_) sink_->on_link({reference, scans_[first + i].position_index, link, num_own});
      for (const PoseHypothesis& pose : link) choices_.scores[first + i - 1].push_back(pose.score);
      if (link.empty()) choices_.scores[first + i - 1].push_back(0.0);
    }
    result_.times.align_s += timed_for(count, [&](std::size_t i) {
      if (first + i >= 2) choices_.bonus[first + i - 2] = companion_scores(first + i - 2);
    });
    const std::size_t needed = static_cast<std::size_t>(options_.smoothing.more_references) + 2;
    for (std::size_t i = 0; i + needed < scans_.size(); ++i) scans_[i].view.reset();
  }

  /// When a link is in doubt: what scans further back say about it, by way of the best links between.
  std::vector<PoseHypothesis> borrow_hypotheses(std::size_t link) const {
    std::vector<PoseHypothesis> borrowed;
    if (!in_doubt(links_[link])) return borrowed;
    HypothesisSearchOptions quick = options_.robust.search;
    quick.hypotheses.all_rotations_below = -std::numeric_limits<double>::infinity();
    const ScanView& reference = *scans_[link].view;
    const ScanView& query = *scans_[link + 1].view;
    const double limit_m = max_shift_m(reference, query, options_.robust.search.voting);
    Pose2 far_from_reference;
    for (std::size_t back = 1; back <= static_cast<std::size_t>(options_.smoothing.more_references); ++back) {
      if (link < back || links_[link - back].empty()) break;
      far_from_reference = links_[link - back].front().ref_from_query * far_from_reference;
      const ScanView& far = *scans_[link - back].view;
      const std::vector<PoseHypothesis> seen_from_far = pose_hypotheses(far, query, quick);
      for (std::size_t k = 0; k < std::min(kBorrowed, seen_from_far.size()); ++k) {
        const Pose2 ref_from_query = inverse(far_from_reference) * seen_from_far[k].ref_from_query;
        if (ref_from_query.translation().lpNorm<Eigen::Infinity>() > limit_m) continue;
        borrowed.push_back(refined_hypothesis(reference, query, ref_from_query, options_.robust.search));
      }
    }
    return borrowed;
  }

  bool in_doubt(const std::vector<PoseHypothesis>& link) const {
    return link.empty() || match_probability(link.front(), lead_of_first(link)) < options_.smoothing.doubt_below;
  }

  /// For each pair of alternatives of a link and the next: how the far scan then goes with the near one.
  std::vector<std::vector<double>> companion_scores(std::size_t link) const {
    std::vector<std::vector<double>> scores(choices_.scores[link].size(),
                                            std::vector<double>(choices_.scores[link + 1].size(), 0.0));
    for (std::size_t a = 0; a < links_[link].size(); ++a) {
      for (std::size_t b = 0; b < links_[link + 1].size(); ++b) {
        const Pose2 near_from_far = links_[link][a].ref_from_query * links_[link + 1][b].ref_from_query;
        scores[a][b] = options_.smoothing.companion_weight *
                       companion_score(visibility(*scans_[link].view, *scans_[link + 2].view, near_from_far,
                                                  options_.robust.search.visibility, kCompanionSlack));
      }
    }
    return scores;
  }

  /// Poses along the chain of best choices.
  void place(const std::vector<Choice>& choices) {
    Pose2 map_from_robot;
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      PositionResult& outcome = result_.positions[scans_[i].position_index];
      outcome.starts_fragment = true;
      if (i > 0) {
        const Choice& choice = choices[i - 1];
        const std::vector<PoseHypothesis>& link = links_[i - 1];
        outcome.alignment = judged(link, choice.alternative, choice.margin, options_.robust.confidence);
        const std::size_t reference = scans_[i - 1].position_index;
        if (sink_) sink_->on_choice({reference, outcome.position_index, choice.alternative, choice.margin});
        outcome.reason = outcome.alignment.reason;
        const bool improbable = outcome.alignment.probability < options_.smoothing.split_below;
        if (improbable && outcome.reason.empty()) outcome.reason = "less probable than it takes not to split the map";
        outcome.starts_fragment = link.empty() || improbable;
        // A pose that is likely to be wrong keeps the map in one piece, and is reported.
        if (!link.empty()) map_from_robot = map_from_robot * link[choice.alternative].ref_from_query;
      }
      if (outcome.starts_fragment) {
        map_from_robot = {};
        result_.fragments.emplace_back();
      }
      outcome.fragment = static_cast<int>(result_.fragments.size()) - 1;

      PlacedPosition placed;
      placed.position_index = outcome.position_index;
      placed.timestamp_s = outcome.timestamp_s;
      placed.map_from_robot = map_from_robot;
      placed.robot_from_sub_scan.resize(log_.positions[placed.position_index].sub_scans.size());
      result_.fragments.back().positions.push_back(std::move(placed));
    }
  }

  const Log& log_;
  const MappingOptions& options_;
  RunObserver& observer_;
  TraceSink* sink_;
  MapResult& result_;
  std::vector<ChainedScan> scans_;
  std::vector<std::vector<PoseHypothesis>> links_;
  ChoiceChain choices_;
};

}  // namespace

void chain_robustly(const Log& log, const MappingOptions& options, RunObserver& observer, TraceSink* sink,
                    MapResult& result) {
  RobustChain(log, options, observer, sink, result).run();
}

}  // namespace shapemap
