// SPDX-License-Identifier: GPL-3.0-or-later
#include "keyframe_retirement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "keyframe_tracker.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/graph/loop_closing.hpp"
#include "shapemap/graph/map_evidence.hpp"
#include "shapemap/graph/path_covariance.hpp"

namespace shapemap {
namespace {

/// A link this probable is as good as one that loops hold.
constexpr double kSure = 0.97;

/// Keyframes that the two are asked of, nearest first.
constexpr std::size_t kTried = 3;

/// The two scans must put each other where the map has them.
constexpr double kMostOff_m = 0.25;
constexpr double kMostOff_rad = 3 * kDegree;

/// What a settled map says of two of its keyframes, as logarithm of odds.
constexpr double kSettledLogOdds = 4.6;

Pose2 between(const KeyframeMap& map, std::size_t a, std::size_t b) {
  return inverse(map.map_from_keyframe[a]) * map.map_from_keyframe[b];
}

std::vector<bool> settled_keyframes(const Log& log, const KeyframeChain& chain, const KeyframeMap& map,
                                    const MappingOptions& options) {
  const std::size_t count = chain.keyframes.size();
  std::vector<bool> sure(chain.links.size());
  for (std::size_t i = 0; i < sure.size(); ++i) {
    sure[i] = map.link_choice[i] != kCut &&
              (map.held_by_loops[i] || link_probability(chain.links[i], options.robust.confidence) >= kSure);
  }
  std::vector<bool> settled(count, false);
  for (std::size_t i = 1; i + kKeyframesInUse < count; ++i) {
    settled[i] = sure[i - 1] && sure[i] && log.positions[chain.keyframes[i].position_index].sub_scans.size() == 1;
  }
  return settled;
}

/// For each keyframe the earlier ones at its place, nearest first.
std::vector<std::vector<std::size_t>> earlier_at_place(const KeyframeMap& map, const KeyframeOptions& options) {
  std::vector<std::vector<std::pair<double, std::size_t>>> near(map.map_from_keyframe.size());
  for (const auto& [a, b] : near_pairs(map.map_from_keyframe, options.step_m)) {
    const Pose2 a_from_b = between(map, a, b);
    if (map.component[a] != map.component[b] || !is_within(a_from_b, options.step_m, options.turn_rad)) continue;
    near[b].emplace_back(a_from_b.translation().norm(), a);
  }
  std::vector<std::vector<std::size_t>> earlier(near.size());
  for (std::size_t b = 0; b < near.size(); ++b) {
    std::sort(near[b].begin(), near[b].end());
    for (const auto& [distance, a] : near[b]) earlier[b].push_back(a);
  }
  return earlier;
}

/// What becomes of a chain when keyframes are taken out of it.
class Retirement {
 public:
  Retirement(const std::vector<std::optional<StandIn>>& stand_ins, const KeyframeMap& map,
             const MappingOptions& options, KeyframeChain& chain, LoopKnowledge& known)
      : stand_ins_(stand_ins), map_(map), options_(options), chain_(chain), known_(known), number_(stand_ins.size()) {
    for (std::size_t i = 0; i < stand_ins.size(); ++i) {
      number_[i] = kept_.size();
      if (!stand_ins[i]) kept_.push_back(i);
    }
  }

  void run() {
    renew_loops();
    attach_scans();
    renew_chain();
  }

 private:
  bool is_kept(std::size_t keyframe) const { return !stand_ins_[keyframe]; }
  std::size_t kept_for(std::size_t keyframe) const {
    return is_kept(keyframe) ? keyframe : stand_ins_[keyframe]->keyframe;
  }

  /// Hypotheses of keyframes that are kept stay; what the map knows of others is said of those that stand for them.
  void renew_loops() {
    std::vector<LoopHypothesis> hypotheses;
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    for (const LoopHypothesis& loop : known_.hypotheses) {
      if (!is_kept(loop.a) || !is_kept(loop.b)) continue;
      hypotheses.push_back(loop);
      hypotheses.back().a = number_[loop.a];
      hypotheses.back().b = number_[loop.b];
      if (is_within(inverse(loop.a_from_b) * between(map_, loop.a, loop.b), kMostOff_m, kMostOff_rad)) {
        pairs.insert({hypotheses.back().a, hypotheses.back().b});
      }
    }
    for (const PoseConstraint& constraint : map_.constraints) {
      const Pose2 as_in_map = between(map_, constraint.a, constraint.b);
      if (!is_within(inverse(constraint.a_from_b) * as_in_map, kMostOff_m, kMostOff_rad)) continue;
      const auto [a, b] = std::minmax({kept_for(constraint.a), kept_for(constraint.b)});
      if (number_[b] - number_[a] < static_cast<std::size_t>(options_.loop_search.shortest_loop)) continue;
      if (!pairs.insert({number_[a], number_[b]}).second) continue;
      hypotheses.push_back({number_[a], number_[b], between(map_, a, b), constraint.covariance, kSettledLogOdds});
    }
    known_.hypotheses = std::move(hypotheses);
    known_.num_searched = number_of_kept_before(known_.num_searched);
    known_.num_bridged = number_of_kept_before(known_.num_bridged);
  }

  std::size_t number_of_kept_before(std::size_t end) const {
    return end < number_.size() ? number_[end] : kept_.size();
  }

  void attach_scans() {
    for (AttachedScan& scan : chain_.attached) {
      const auto& stand_in = stand_ins_[scan.keyframe];
      if (stand_in) scan.pose.ref_from_query = stand_in->pose.ref_from_query * scan.pose.ref_from_query;
      scan.keyframe = number_[kept_for(scan.keyframe)];
    }
    for (std::size_t i = 0; i < stand_ins_.size(); ++i) {
      if (is_kept(i)) continue;
      const StandIn& stand_in = *stand_ins_[i];
      chain_.attached.push_back({chain_.keyframes[i].position_index, number_[stand_in.keyframe], stand_in.pose});
    }
  }

  void renew_chain() {
    const PathCovariance covariance(map_.map_from_keyframe, map_.constraints);
    KeyframeChain renewed;
    renewed.attached = std::move(chain_.attached);
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      renewed.keyframes.push_back(std::move(chain_.keyframes[kept_[k]]));
      if (k == 0) continue;
      const std::size_t before = kept_[k - 1];
      const bool are_neighbours = before + 1 == kept_[k];
      renewed.links.push_back(are_neighbours ? std::move(chain_.links[before])
                                             : settled_link(before, kept_[k], covariance));
    }
    for (std::size_t i = 0; i + 1 < renewed.links.size(); ++i) {
      KeyframeLink& link = renewed.links[i];
      if (kept_[i + 2] != kept_[i] + 2) link.bonus = no_bonus(link, renewed.links[i + 1]);
    }
    chain_ = std::move(renewed);
    choose_hypotheses(chain_);
  }

  KeyframeLink settled_link(std::size_t a, std::size_t b, const PathCovariance& covariance) const {
    KeyframeLink link;
    PoseHypothesis pose;
    pose.ref_from_query = between(map_, a, b);
    link.hypotheses = {pose};
    link.settled_covariance = covariance.between(a, b);
    return link;
  }

  const std::vector<std::optional<StandIn>>& stand_ins_;
  const KeyframeMap& map_;
  const MappingOptions& options_;
  KeyframeChain& chain_;
  LoopKnowledge& known_;
  std::vector<std::size_t> kept_;    ///< the keyframes that stay
  std::vector<std::size_t> number_;  ///< per keyframe: how many before it stay
};

}  // namespace

std::vector<std::optional<StandIn>> find_stand_ins(const Log& log, const KeyframeChain& chain, const KeyframeMap& map,
                                                   const MappingOptions& options) {
  const std::vector<bool> settled = settled_keyframes(log, chain, map, options);
  const std::vector<std::vector<std::size_t>> earlier = earlier_at_place(map, options.keyframes);
  std::vector<std::vector<StandIn>> fitting(settled.size());
  parallel_for(settled.size(), options.chain.threads, [&](std::size_t b) {
    if (!settled[b]) return;
    for (const std::size_t a : earlier[b]) {
      if (fitting[b].size() == kTried) break;
      const Pose2 expected = between(map, a, b);
      const PoseHypothesis pose =
          refined_hypothesis(*chain.keyframes[a].view, *chain.keyframes[b].view, expected, options.robust.search);
      const bool is_as_in_map = is_within(inverse(expected) * pose.ref_from_query, kMostOff_m, kMostOff_rad);
      if (is_as_in_map && can_stand_for(pose)) fitting[b].push_back({a, pose});
    }
  });
  std::vector<std::optional<StandIn>> stand_ins(settled.size());
  for (std::size_t b = 0; b < settled.size(); ++b) {
    for (const StandIn& candidate : fitting[b]) {
      if (stand_ins[candidate.keyframe]) continue;  // it is not kept itself
      stand_ins[b] = candidate;
      break;
    }
  }
  return stand_ins;
}

void retire_keyframes(const std::vector<std::optional<StandIn>>& stand_ins, const KeyframeMap& map,
                      const MappingOptions& options, KeyframeChain& chain, LoopKnowledge& known) {
  Retirement(stand_ins, map, options, chain, known).run();
}

}  // namespace shapemap
