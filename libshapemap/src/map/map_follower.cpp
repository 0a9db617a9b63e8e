// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_follower.hpp"

#include <algorithm>

#include "shapemap/graph/loop_closing.hpp"

namespace shapemap {
namespace {

/// Past more keyframes of new places, errors may have added up.
constexpr std::size_t kMostUnseen = 8;

/// So many in a row that are where they were expected are no coincidence where errors have only added up.
constexpr std::size_t kWitnesses = 3;

/// Whether the robot is at a place or at one that looks alike, as one of a row of rooms does for a while, is judged by
/// the next so many keyframes: all but a few are known at the right place, and fewer than half at others.
constexpr std::size_t kLookAhead = 24;
constexpr std::size_t kMostUnknown = 4;
constexpr std::size_t kRival = 12;

/// Which of several places it is.
class PlaceChoice {
 public:
  /// True when it is the best so far.
  bool add(const Pose2& place, std::size_t num_known) {
    const bool is_first = num_known_ == 0 && num_known > 0;
    const bool is_same = !is_first && is_within(inverse(best_) * place, kAsInMap_m, kAsInMap_rad);
    const bool is_better = num_known > num_known_;
    if (!is_same) num_rival_ = std::max(num_rival_, is_better ? num_known_ : num_known);
    if (!is_better) return false;
    best_ = place;
    num_known_ = num_known;
    return true;
  }

  bool is_sure() const { return num_known_ + kMostUnknown >= kLookAhead && num_rival_ < kRival; }

 private:
  Pose2 best_;
  std::size_t num_known_ = 0;
  std::size_t num_rival_ = 0;
};

}  // namespace

MapFollower::MapFollower(const KeyframeChain& chain, const MappingOptions& options, std::size_t home, std::size_t first,
                         Bearings bearings, KeyframeMap& map)
    : chain_(chain),
      options_(options),
      home_(home),
      map_(map),
      bearings_(bearings),
      stand_ins_(chain.keyframes.size()),
      last_known_(bearings.is_lost || bearings.num_unseen > 0 ? 0 : first - 1),
      lost_(first) {}

std::size_t MapFollower::go(std::size_t first, std::size_t last) {
  for (std::size_t b = first; b < last; ++b) {
    const bool doubts = is_in_doubt(b);
    if (doubts && !bearings_.is_lost && b + kLookAhead > last) return b;
    if (doubts) doubt_link(b);
    step(b);
  }
  return witnesses_.empty() ? last : witnesses_.front().first;
}

void MapFollower::expect(std::size_t b) {
  const int choice = map_.link_choice[b - 1];
  if (choice == kCut) {
    map_.map_from_keyframe[b] = {kPiecesApart_m * static_cast<double>(b), 0.0, 0.0};
    return;
  }
  const std::vector<PoseHypothesis>& hypotheses = chain_.links[b - 1].hypotheses;
  map_.map_from_keyframe[b] =
      map_.map_from_keyframe[b - 1] * hypotheses[static_cast<std::size_t>(choice)].ref_from_query;
}

bool MapFollower::link_exists(std::size_t b) const { return map_.link_choice[b - 1] != kCut; }

bool MapFollower::is_in_doubt(std::size_t b) const {
  return link_exists(b) && link_probability(chain_.links[b - 1], options_.robust.confidence) < kSureLink;
}

void MapFollower::step(std::size_t b) {
  expect(b);
  if (!link_exists(b)) {
    get_lost(b);
    bearings_.is_in_doubt = true;
    lost_ = b;
    last_known_ = 0;
    witnesses_.clear();
  }
  std::vector<StandIn> found;
  if (!bearings_.is_in_doubt) found = stand_ins_at(b);
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

void MapFollower::get_lost(std::size_t b) {
  if (bearings_.is_lost) return;
  bearings_.is_lost = true;
  lost_ = b;
}

void MapFollower::know(std::size_t b, StandIn stand_in) {
  map_.constraints.push_back(
      {stand_in.keyframe, b, stand_in.pose.ref_from_query, pose_covariance(stand_in.pose.fit), 0.0});
  hold_back_from(b);
  map_.component[b] = home_;
  last_known_ = b;
  stand_ins_[b] = std::move(stand_in);
}

/// What is between a keyframe that is known again and the last one that was is held from both ends.
void MapFollower::hold_back_from(std::size_t b) {
  for (std::size_t i = b; i > last_known_ && map_.link_choice[i - 1] != kCut; --i) {
    map_.held_by_loops[i - 1] = true;
    map_.component[i] = home_;
    if (last_known_ == 0 && map_.component[i - 1] == home_) break;
  }
}

/// Takes the alternative of the link to `b` after which what follows is known again, and after no other. Without one
/// the chain's own stays, and only settling tells where the robot is.
void MapFollower::doubt_link(std::size_t b) {
  const bool was_lost = bearings_.is_lost;
  get_lost(b);
  bearings_.is_in_doubt = true;
  witnesses_.clear();
  if (was_lost) return;
  const int chosen = map_.link_choice[b - 1];
  PlaceChoice places;
  int best = chosen;
  for (int k = 0; k < static_cast<int>(chain_.links[b - 1].hypotheses.size()); ++k) {
    map_.link_choice[b - 1] = k;
    expect(b);
    const Pose2 there = map_.map_from_keyframe[b];
    if (places.add(there, num_known_from(b))) best = k;
  }
  map_.link_choice[b - 1] = places.is_sure() ? best : chosen;
  bearings_.is_in_doubt = !places.is_sure();
}

/// Of the keyframes from `b`, which is where it may be: how many are known where they are then expected. Gives up when
/// that is sure to be fewer than a rival.
std::size_t MapFollower::num_known_from(std::size_t b) {
  std::size_t known = 0;
  for (std::size_t j = b; j < b + kLookAhead; ++j) {
    if (j > b && !link_exists(j)) break;
    if (j > b) expect(j);
    const std::vector<StandIn> found = stand_ins_at(j);
    if (!found.empty()) {
      ++known;
      map_.map_from_keyframe[j] = map_.map_from_keyframe[found.front().keyframe] * found.front().pose.ref_from_query;
    } else if (known + (b + kLookAhead - j - 1) < kRival) {
      break;
    }
  }
  return known;
}

std::vector<StandIn> MapFollower::stand_ins_at(std::size_t b) const {
  return stand_ins_for(chain_, map_.map_from_keyframe, b, earlier_at_place(b), 1, options_);
}

/// Of those that stay, the nearest to where `b` is expected. When lost, those just before it are no witnesses.
std::vector<std::size_t> MapFollower::earlier_at_place(std::size_t b) const {
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
  for (std::size_t k = 0; k < std::min(kStandInsTried, near.size()); ++k) nearest.push_back(near[k].second);
  return nearest;
}

}  // namespace shapemap
