// SPDX-License-Identifier: GPL-3.0-or-later
#include "place_hypotheses.hpp"

#include <algorithm>
#include <utility>

#include "shapemap/inference/map_search.hpp"

namespace shapemap {
namespace {

/// Of a stretch, at least sixteen keyframes are known; and eight more than at any other place.
constexpr double kLeastLogOdds = 8.0;
constexpr double kLeastLead = 4.0;

bool are_one_place(const PlacedStretch& one, const PlacedStretch& other) {
  const auto agree = [](const Pose2& a, const Pose2& b) {
    return is_within(inverse(a) * b, kContradicts_m, kContradicts_rad);
  };
  return agree(one.map_from_keyframe.front(), other.map_from_keyframe.front()) &&
         agree(one.map_from_keyframe.back(), other.map_from_keyframe.back());
}

}  // namespace

bool PlaceHypotheses::add(PlacedStretch laid) {
  tried_.push_back(std::move(laid));
  if (tried_.size() > 1 && tried_.back().log_odds <= tried_[best_].log_odds) return false;
  best_ = tried_.size() - 1;
  return true;
}

bool PlaceHypotheses::has(std::size_t keyframe, const Pose2& map_from_keyframe) const {
  return std::any_of(tried_.begin(), tried_.end(), [&](const PlacedStretch& laid) {
    return is_within(inverse(laid.map_from_keyframe[keyframe]) * map_from_keyframe, kAsInMap_m, kAsInMap_rad);
  });
}

bool PlaceHypotheses::is_sure() const {
  if (tried_.empty() || best().log_odds < kLeastLogOdds) return false;
  return std::all_of(tried_.begin(), tried_.end(), [&](const PlacedStretch& laid) {
    return best().log_odds - laid.log_odds >= kLeastLead || are_one_place(best(), laid);
  });
}

}  // namespace shapemap
