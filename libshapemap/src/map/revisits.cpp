// SPDX-License-Identifier: GPL-3.0-or-later
#include "revisits.hpp"

#include <algorithm>
#include <utility>

#include "shapemap/graph/loop_closing.hpp"

namespace shapemap {
namespace {

/// Past more keyframes of new places, errors may have added up.
constexpr std::size_t kMostUnseen = 8;

/// So many in a row that are where they were expected are no coincidence.
constexpr std::size_t kWitnesses = 3;

/// A link in doubt is judged by the next few keyframes.
constexpr std::size_t kLookAhead = 8;

/// Nearest first.
constexpr std::size_t kTried = 3;

/// What the chain says of links that the map does not know.
void add_links(const KeyframeChain& chain, KeyframeMap& map) {
  for (std::size_t i = map.link_choice.size(); i < chain.links.size(); ++i) {
    const KeyframeLink& link = chain.links[i];
    map.link_choice.push_back(link.hypotheses.empty() ? kCut : static_cast<int>(link.choice.alternative));
    map.held_by_loops.push_back(false);
  }
}

void add_link_constraints(const KeyframeChain& chain, std::size_t first, KeyframeMap& map) {
  for (std::size_t i = first; i < chain.links.size(); ++i) {
    if (map.link_choice[i] == kCut) continue;
    map.constraints.push_back(link_constraint(chain, i, static_cast<std::size_t>(map.link_choice[i])));
  }
}

/// One go along the keyframes that are new.
class Following {
 public:
  /// `map` has links and a place for all keyframes; those before `first` are in theirs.
  Following(const KeyframeChain& chain, const MappingOptions& options, std::size_t home, std::size_t first,
            Bearings bearings, KeyframeMap& map)
      : chain_(chain),
        options_(options),
        home_(home),
        map_(map),
        bearings_(bearings),
        stand_ins_(chain.keyframes.size()),
        last_known_(bearings.is_lost || bearings.num_unseen > 0 ? 0 : first - 1),
        lost_(first) {}

  /// Puts a keyframe where the link to it says.
  void expect(std::size_t b) {
    const int choice = map_.link_choice[b - 1];
    if (choice == kCut) {
      map_.map_from_keyframe[b] = {kPiecesApart_m * static_cast<double>(b), 0.0, 0.0};
      return;
    }
    const std::vector<PoseHypothesis>& hypotheses = chain_.links[b - 1].hypotheses;
    map_.map_from_keyframe[b] =
        map_.map_from_keyframe[b - 1] * hypotheses[static_cast<std::size_t>(choice)].ref_from_query;
  }

  /// Along keyframes up to `last`; returns where to go on next time: what only begins to be known again is looked at
  /// anew then, and so is a link in doubt of which too little is known of what comes after.
  std::size_t go(std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b) {
      if (!bearings_.is_lost && is_in_doubt(b)) {
        if (b + kLookAhead > last) return b;
        get_lost(b);
        choose_by_what_follows(b);
      }
      step(b);
    }
    return witnesses_.empty() ? last : witnesses_.front().first;
  }

  const Bearings& bearings() const { return bearings_; }
  std::vector<std::optional<StandIn>>& stand_ins() { return stand_ins_; }

 private:
  bool link_exists(std::size_t b) const { return map_.link_choice[b - 1] != kCut; }
  bool is_in_doubt(std::size_t b) const {
    return link_exists(b) && link_probability(chain_.links[b - 1], options_.robust.confidence) < kSureLink;
  }

  void step(std::size_t b) {
    expect(b);
    if (!link_exists(b)) {
      get_lost(b);
      lost_ = b;
      last_known_ = 0;
      witnesses_.clear();
    } else if (is_in_doubt(b)) {
      get_lost(b);
    }
    std::vector<StandIn> found = stand_ins_at(b);
    if (found.empty()) {
      witnesses_.clear();
      if (++bearings_.num_unseen > kMostUnseen) get_lost(b);
      map_.component[b] = bearings_.is_lost ? lost_ : home_;
      return;
    }
    map_.map_from_keyframe[b] = map_.map_from_keyframe[found.front().keyframe] * found.front().pose.ref_from_query;
    map_.component[b] = bearings_.is_lost ? lost_ : home_;
    witnesses_.emplace_back(b, std::move(found.front()));
    if (bearings_.is_lost && witnesses_.size() < kWitnesses) return;
    for (auto& [keyframe, stand_in] : witnesses_) know(keyframe, std::move(stand_in));
    witnesses_.clear();
    bearings_ = {};
  }

  /// The one alternative of the link to `b` after which several keyframes in a row are where they are expected. The
  /// chain's own stays when there is none, or more than one.
  void choose_by_what_follows(std::size_t b) {
    const int chosen = map_.link_choice[b - 1];
    std::vector<int> possible;
    for (int k = 0; k < static_cast<int>(chain_.links[b - 1].hypotheses.size()); ++k) {
      map_.link_choice[b - 1] = k;
      if (is_known_after(b)) possible.push_back(k);
    }
    map_.link_choice[b - 1] = possible.size() == 1 ? possible.front() : chosen;
  }

  bool is_known_after(std::size_t b) {
    std::size_t in_a_row = 0;
    for (std::size_t j = b; j < b + kLookAhead && link_exists(j) && in_a_row < kWitnesses; ++j) {
      expect(j);
      const std::vector<StandIn> found = stand_ins_at(j);
      in_a_row = found.empty() ? 0 : in_a_row + 1;
      if (found.empty()) continue;
      map_.map_from_keyframe[j] = map_.map_from_keyframe[found.front().keyframe] * found.front().pose.ref_from_query;
    }
    return in_a_row == kWitnesses;
  }

  std::vector<StandIn> stand_ins_at(std::size_t b) const {
    return stand_ins_for(chain_, map_.map_from_keyframe, b, earlier_at_place(b), 1, options_);
  }

  void get_lost(std::size_t b) {
    if (bearings_.is_lost) return;
    bearings_.is_lost = true;
    lost_ = b;
  }

  /// Of those that stay, the nearest to where `b` is expected. When lost, those just before it are no witnesses.
  std::vector<std::size_t> earlier_at_place(std::size_t b) const {
    const std::size_t end = bearings_.is_lost ? b - std::min(b, kKeyframesInUse) : b;
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t a = 0; a < end; ++a) {
      if (map_.component[a] != home_ || stand_ins_[a]) continue;
      const Pose2 a_from_b = inverse(map_.map_from_keyframe[a]) * map_.map_from_keyframe[b];
      if (is_within(a_from_b, options_.keyframes.step_m, options_.keyframes.turn_rad)) {
        near.emplace_back(a_from_b.translation().norm(), a);
      }
    }
    std::sort(near.begin(), near.end());
    std::vector<std::size_t> nearest;
    for (std::size_t k = 0; k < std::min(kTried, near.size()); ++k) nearest.push_back(near[k].second);
    return nearest;
  }

  void know(std::size_t b, StandIn stand_in) {
    map_.constraints.push_back(
        {stand_in.keyframe, b, stand_in.pose.ref_from_query, pose_covariance(stand_in.pose.fit), 0.0});
    hold_back_from(b);
    map_.component[b] = home_;
    last_known_ = b;
    stand_ins_[b] = std::move(stand_in);
  }

  /// What is between a keyframe that is known again and the last one that was is held from both ends.
  void hold_back_from(std::size_t b) {
    for (std::size_t i = b; i > last_known_ && map_.link_choice[i - 1] != kCut; --i) {
      map_.held_by_loops[i - 1] = true;
      map_.component[i] = home_;
      if (last_known_ == 0 && map_.component[i - 1] == home_) break;
    }
  }

  const KeyframeChain& chain_;
  const MappingOptions& options_;
  std::size_t home_;
  KeyframeMap& map_;
  Bearings bearings_;
  std::vector<std::optional<StandIn>> stand_ins_;
  std::vector<std::pair<std::size_t, StandIn>> witnesses_;  ///< known again in a row, if it is true
  std::size_t last_known_;                                  ///< of this go; 0: none
  std::size_t lost_;                                        ///< the first keyframe of what may be anywhere
};

}  // namespace

void Revisits::start(const KeyframeChain& chain, const KeyframeMap& map, std::size_t num_settled) {
  bearings_ = {};
  home_position_ = chain.keyframes[map.component[num_settled - 1]].position_index;
  renew(map, chain.keyframes.size() - num_settled);
}

Revisits::Followed Revisits::follow(const KeyframeChain& chain) {
  const std::size_t first = settled_.map_from_keyframe.size();
  const std::size_t count = chain.keyframes.size();
  const std::size_t last = count - std::min(count, kKeyframesInUse);
  Followed result;
  result.map = settled_;
  add_links(chain, result.map);
  result.map.map_from_keyframe.resize(count);
  for (std::size_t i = first; i < count; ++i) result.map.component.push_back(i);
  const auto home =
      std::lower_bound(chain.keyframes.begin(), chain.keyframes.end(), home_position_,
                       [](const Keyframe& k, std::size_t position) { return k.position_index < position; });
  const std::size_t home_component = result.map.component[static_cast<std::size_t>(home - chain.keyframes.begin())];
  Following following(chain, options_, home_component, first, bearings_, result.map);
  result.num_followed = following.go(first, std::max(first, last));
  for (std::size_t b = result.num_followed; b < count; ++b) following.expect(b);
  add_link_constraints(chain, first - 1, result.map);
  bearings_ = following.bearings();
  result.stand_ins = std::move(following.stand_ins());
  const std::vector<bool> may_go = settled_keyframes(log_, chain, result.map, options_);
  for (std::size_t b = first; b < count; ++b) {
    if (!may_go[b]) result.stand_ins[b].reset();
  }
  return result;
}

void Revisits::renew(KeyframeMap map, std::size_t num_open) {
  const std::size_t count = map.map_from_keyframe.size() - num_open;
  map.map_from_keyframe.resize(count);
  map.component.resize(count);
  map.link_choice.resize(count - 1);
  map.held_by_loops.resize(count - 1);
  const auto is_open = [&](const PoseConstraint& constraint) { return std::max(constraint.a, constraint.b) >= count; };
  map.constraints.erase(std::remove_if(map.constraints.begin(), map.constraints.end(), is_open), map.constraints.end());
  settled_ = std::move(map);
}

}  // namespace shapemap
