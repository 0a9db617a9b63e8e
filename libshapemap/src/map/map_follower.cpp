// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_follower.hpp"

#include <algorithm>
#include <limits>

#include "loop_knowledge.hpp"
#include "shapemap/core/observer.hpp"
#include "shapemap/graph/loop_closing.hpp"
#include "shapemap/graph/loop_hypotheses.hpp"

namespace shapemap {
namespace {

/// Past more keyframes of new places, errors may have added up.
constexpr std::size_t kMostUnseen = 8;

/// So many in a row that are where they were expected are no coincidence where errors have only added up.
constexpr std::size_t kWitnesses = 3;

/// After a link in doubt the robot may be at a place that looks alike: a few of a row of rooms do for a while.
constexpr std::size_t kWitnessesAfterDoubt = 8;
constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

/// A link in doubt, and a place that was searched for, are judged by the next few keyframes.
constexpr std::size_t kLookAhead = 12;

/// And of these so many in a row are known where it may be the right one.
constexpr std::size_t kInARowWhenFound = 5;

/// Who is lost searches after so many keyframes, and again.
constexpr std::size_t kSearchEvery = 16;

/// Nearest first.
constexpr std::size_t kTried = 3;

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
    const bool can_look_ahead = b + kLookAhead <= last;
    if (!bearings_.is_lost && is_in_doubt(b)) {
      if (!can_look_ahead) return b;
      get_lost(b, kWitnessesAfterDoubt);
      choose_by_what_follows(b);
    }
    const bool searches = bearings_.is_lost && !bearings_.may_be_elsewhere && can_look_ahead &&
                          bearings_.num_unseen > 0 && bearings_.num_unseen % kSearchEvery == 0;
    if (searches) bearings_.num_found = is_known_somewhere(b) ? bearings_.num_found + 1 : 0;
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
    get_lost(b, kNever);
    bearings_.may_be_elsewhere = true;
    lost_ = b;
    last_known_ = 0;
    witnesses_.clear();
  } else if (is_in_doubt(b)) {
    get_lost(b, kWitnessesAfterDoubt);
  }
  std::vector<StandIn> found = stand_ins_at(b);
  if (found.empty()) {
    witnesses_.clear();
    if (++bearings_.num_unseen > kMostUnseen) get_lost(b, kWitnesses);
    map_.component[b] = bearings_.is_lost ? lost_ : home_;
    return;
  }
  map_.map_from_keyframe[b] = map_.map_from_keyframe[found.front().keyframe] * found.front().pose.ref_from_query;
  map_.component[b] = bearings_.is_lost ? lost_ : home_;
  witnesses_.emplace_back(b, std::move(found.front()));
  if (bearings_.is_lost && witnesses_.size() < bearings_.witnesses_needed) return;
  for (auto& [keyframe, stand_in] : witnesses_) know(keyframe, std::move(stand_in));
  witnesses_.clear();
  bearings_ = {};
}

void MapFollower::get_lost(std::size_t b, std::size_t witnesses_needed) {
  bearings_.witnesses_needed = std::max(bearings_.witnesses_needed, witnesses_needed);
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

/// The alternative of the link to `b` after which what follows is known again, where there is but one that some of it
/// is known after: when there are more, only settling tells.
void MapFollower::choose_by_what_follows(std::size_t b) {
  const int chosen = map_.link_choice[b - 1];
  int sure = chosen;
  std::size_t num_possible = 0;
  for (int k = 0; k < static_cast<int>(chain_.links[b - 1].hypotheses.size()); ++k) {
    map_.link_choice[b - 1] = k;
    expect(b);
    const std::size_t in_a_row = longest_known_from(b);
    if (in_a_row >= kWitnesses) ++num_possible;
    if (in_a_row >= kWitnessesAfterDoubt) sure = k;
  }
  map_.link_choice[b - 1] = num_possible == 1 ? sure : chosen;
  if (num_possible > 1) bearings_.witnesses_needed = kNever;
}

/// Of the keyframes from `b`, which is where it may be: the most in a row that are known where they are then expected.
std::size_t MapFollower::longest_known_from(std::size_t b) {
  std::size_t longest = 0;
  std::size_t in_a_row = 0;
  for (std::size_t j = b; j < b + kLookAhead; ++j) {
    if (j > b && !link_exists(j)) break;
    if (j > b) expect(j);
    const std::vector<StandIn> found = stand_ins_at(j);
    in_a_row = found.empty() ? 0 : in_a_row + 1;
    longest = std::max(longest, in_a_row);
    if (found.empty()) continue;
    map_.map_from_keyframe[j] = map_.map_from_keyframe[found.front().keyframe] * found.front().pose.ref_from_query;
  }
  return longest;
}

/// Whether there is a place in the map from which on the robot may have gone as it did.
bool MapFollower::is_known_somewhere(std::size_t b) {
  NodeViews views = views_of(chain_);
  views.resize(b + 1);
  RunObserver nobody;
  const std::vector<LoopHypothesis> places =
      likely_loops(views, b, options_.robust.search, options_.loop_search, options_.chain.threads, nobody);
  return std::any_of(places.begin(), places.end(), [&](const LoopHypothesis& place) {
    if (map_.component[place.a] != home_ || stand_ins_[place.a]) return false;
    map_.map_from_keyframe[b] = map_.map_from_keyframe[place.a] * place.a_from_b;
    return longest_known_from(b) >= kInARowWhenFound;
  });
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
  for (std::size_t k = 0; k < std::min(kTried, near.size()); ++k) nearest.push_back(near[k].second);
  return nearest;
}

}  // namespace shapemap
