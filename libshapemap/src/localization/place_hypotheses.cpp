// SPDX-License-Identifier: GPL-3.0-or-later
#include "place_hypotheses.hpp"

#include <algorithm>
#include <utility>

#include "inference/inference_numbers.hpp"
#include "localization_numbers.hpp"
#include "shapemap/inference/map_search.hpp"

namespace shapemap {
namespace {

bool are_one_place(const PlacedStretch& one, const PlacedStretch& other) {
  const PoseTolerance& tolerance = kInference.agreement.contradicts;
  return agrees(one.map_from_keyframe.front(), other.map_from_keyframe.front(), tolerance) &&
         agrees(one.map_from_keyframe.back(), other.map_from_keyframe.back(), tolerance);
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
    return agrees(laid.map_from_keyframe[keyframe], map_from_keyframe, kLocalization.redundancy.as_in_map);
  });
}

bool PlaceHypotheses::is_sure() const {
  if (tried_.empty() || best().log_odds < kLocalization.places.least_log_odds) return false;
  return std::all_of(tried_.begin(), tried_.end(), [&](const PlacedStretch& laid) {
    return best().log_odds - laid.log_odds >= kLocalization.places.least_lead || are_one_place(best(), laid);
  });
}

}  // namespace shapemap
