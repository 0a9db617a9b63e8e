// SPDX-License-Identifier: GPL-3.0-or-later
#include "keyframe_culling.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "shapemap/graph/relative_covariance.hpp"
#include "shapemap/inference/map_search.hpp"

namespace shapemap {
namespace {

/// What a settled map says of two of its keyframes, as logarithm of odds.
constexpr double kSettledLogOdds = 4.6;

Pose2 between(const KeyframeMap& map, std::size_t a, std::size_t b) {
  return inverse(map.map_from_keyframe[a]) * map.map_from_keyframe[b];
}

/// What becomes of a chain when keyframes are taken out of it.
class Retirement {
 public:
  Retirement(const std::vector<std::optional<StandIn>>& stand_ins, const MappingOptions& options, KeyframeMap& map,
             KeyframeChain& chain, LoopKnowledge& known)
      : stand_ins_(stand_ins), options_(options), map_(map), chain_(chain), known_(known), number_(stand_ins.size()) {
    for (std::size_t i = 0; i < stand_ins.size(); ++i) {
      number_[i] = kept_.size();
      if (!stand_ins[i]) kept_.push_back(i);
    }
  }

  void run() {
    renew_loops();
    attach_scans();
    renew_chain();
    renew_map();
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
      if (is_within(inverse(loop.a_from_b) * between(map_, loop.a, loop.b), kAsInMap_m, kAsInMap_rad)) {
        pairs.insert({hypotheses.back().a, hypotheses.back().b});
      }
    }
    for (const PoseConstraint& constraint : map_.constraints) {
      const Pose2 as_in_map = between(map_, constraint.a, constraint.b);
      if (!is_within(inverse(constraint.a_from_b) * as_in_map, kAsInMap_m, kAsInMap_rad)) continue;
      const auto [a, b] = std::minmax({kept_for(constraint.a), kept_for(constraint.b)});
      if (number_[b] - number_[a] < static_cast<std::size_t>(options_.robust.loop_detection.shortest_loop)) continue;
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

  void renew_map() {
    KeyframeMap renewed;
    renewed.constraints = renewed_constraints();
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      renewed.map_from_keyframe.push_back(map_.map_from_keyframe[kept_[k]]);
      renewed.component.push_back(number_[kept_for(map_.component[kept_[k]])]);
      if (k == 0) continue;
      const std::size_t before = kept_[k - 1];
      const bool are_neighbours = before + 1 == kept_[k];
      renewed.link_choice.push_back(are_neighbours ? map_.link_choice[before] : 0);
      renewed.held_by_loops.push_back(!are_neighbours || map_.held_by_loops[before]);
      if (!are_neighbours) renewed.constraints.push_back(link_constraint(chain_, k - 1, 0));
    }
    renewed.loops = std::move(map_.loops);
    map_ = std::move(renewed);
  }

  /// Of those that go, one for each pair of those that stand for them, and only where there is none.
  std::vector<PoseConstraint> renewed_constraints() const {
    std::vector<PoseConstraint> constraints;
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    for (const bool of_kept : {true, false}) {
      for (PoseConstraint constraint : map_.constraints) {
        if ((is_kept(constraint.a) && is_kept(constraint.b)) != of_kept) continue;
        const auto [a, b] = std::minmax({kept_for(constraint.a), kept_for(constraint.b)});
        const bool is_new = pairs.insert({a, b}).second;
        if (!of_kept) {
          if (a == b || !is_new) continue;
          constraint.a_from_b = between(map_, a, b);
        }
        constraint.a = number_[a];
        constraint.b = number_[b];
        constraints.push_back(constraint);
      }
    }
    return constraints;
  }

  const std::vector<std::optional<StandIn>>& stand_ins_;
  const MappingOptions& options_;
  KeyframeMap& map_;
  KeyframeChain& chain_;
  LoopKnowledge& known_;
  std::vector<std::size_t> kept_;    ///< the keyframes that stay
  std::vector<std::size_t> number_;  ///< per keyframe: how many before it stay
};

}  // namespace

void retire_keyframes(const std::vector<std::optional<StandIn>>& stand_ins, const MappingOptions& options,
                      KeyframeMap& map, KeyframeChain& chain, LoopKnowledge& known) {
  Retirement(stand_ins, options, map, chain, known).run();
}

}  // namespace shapemap
