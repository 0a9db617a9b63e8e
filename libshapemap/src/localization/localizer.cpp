// SPDX-License-Identifier: GPL-3.0-or-later
#include "localizer.hpp"

#include <algorithm>

#include "inference/inference_numbers.hpp"
#include "localization_numbers.hpp"
#include "place_hypotheses.hpp"
#include "shapemap/inference/map_search.hpp"

namespace shapemap {
Localizer::Localizer(const KeyframeGraph& graph, const RobustOptions& options, const LocalizationStart& start,
                     const std::vector<EdgeCandidate>& loops, OptimizedMap& map)
    : graph_(graph),
      options_(options),
      loops_(loops),
      map_(map),
      verification_(graph, options, start.active_component),
      redundant_(graph.keyframes.size()),
      state_(start.state),
      log_odds_(start.state.log_odds),
      open_(start.first),
      good_(start.first),
      last_informative_(start.first),
      last_replaced_(start.first - 1) {}

std::size_t Localizer::go(std::size_t last) {
  for (std::size_t b = open_; b < last && !state_.is_lost; ++b) {
    const bool doubts = is_in_doubt(b);
    if (doubts && b + kLocalization.localizer.look_ahead > last) break;
    if (!edge_exists(b) || (doubts && !decide(b))) {
      make_certain(good_);  // the robot's place is known up to here, but not where it went on
      get_lost();
    } else if (!step(b)) {
      get_lost();
    }
  }
  if (state_.is_lost) relocalize(last);
  return open_;
}

void Localizer::expect(std::size_t b) {
  if (edge_exists(b)) {
    map_.map_from_keyframe[b] = map_.map_from_keyframe[b - 1] * edge_in_map(graph_, map_, b);
  } else {
    map_.map_from_keyframe[b] = {kInference.search.components_apart_m * static_cast<double>(b), 0.0, 0.0};
  }
}

bool Localizer::edge_exists(std::size_t b) const { return map_.edge_choice[b - 1] != kCut; }

bool Localizer::is_in_doubt(std::size_t b) const {
  return edge_exists(b) && stated_probability(graph_.edges[b - 1]) < kLocalization.redundancy.sure_edge;
}

/// Returns false when the robot cannot be where it is expected.
bool Localizer::step(std::size_t b) {
  expect(b);
  map_.component[b] = verification_.active_component();
  PlaceEvidence seen = verification_.look(map_, b, b);
  const bool is_new = !seen.replacement && seen.log_odds == 0.0;
  if (is_new && good_ == b)
    seen.log_odds =
        -std::clamp(log_odds_ - kLocalization.localizer.least_of_new, 0.0, kLocalization.localizer.error_of_new);
  log_odds_ = std::min(kLocalization.places.sure_of_place, log_odds_ + seen.log_odds);
  if (log_odds_ < 0.0) return false;
  const bool is_informative = seen.log_odds > 0.0 || seen.log_odds < -kLocalization.localizer.error_of_new;
  last_informative_ = is_informative ? b : last_informative_;
  if (seen.replacement) {
    map_.map_from_keyframe[b] = pose_by(map_, *seen.replacement);
    verification_.exclude(b);
    pending_.emplace_back(b, std::move(*seen.replacement));
  }
  const bool is_long_without = b >= last_informative_ + kLocalization.localizer.look_ahead;
  if (is_long_without && log_odds_ < kLocalization.places.sure_of_place) forget_pending();
  if (log_odds_ == kLocalization.places.sure_of_place || (good_ == b && !is_informative) || is_long_without) {
    good_ = b + 1;
    make_certain(good_ - std::min(good_, kLocalization.localizer.lag));
  }
  return true;
}

/// Drops replacements that were never confirmed: these keyframes stay in the map.
void Localizer::forget_pending() {
  for (const auto& [keyframe, unused] : pending_) verification_.include(keyframe);
  pending_.clear();
}

void Localizer::make_certain(std::size_t end) {
  if (end <= open_) return;
  auto open = pending_.begin();
  for (; open != pending_.end() && open->first < end; ++open) replace(open->first, std::move(open->second));
  pending_.erase(pending_.begin(), open);
  open_ = end;
  state_.log_odds = log_odds_;
}

void Localizer::replace(std::size_t b, ReplacementKeyframe replacement) {
  map_.constraints.push_back(
      {replacement.keyframe, b, replacement.pose.ref_from_query, pose_covariance(replacement.pose.fit), 0.0});
  constrain_edges_before(b);
  last_replaced_ = b;
  verification_.exclude(b);
  redundant_[b] = std::move(replacement);
}

/// The edges between two recognised keyframes are constrained from both ends, as in a loop.
void Localizer::constrain_edges_before(std::size_t b) {
  for (std::size_t i = b; i > last_replaced_ && edge_exists(i); --i) {
    if (map_.component[i - 1] != verification_.active_component()) break;
    map_.loop_constrained[i - 1] = true;
  }
}

/// Takes the candidate of the edge to `b` after which the map recognises the following keyframes. Returns false when
/// that singles out no candidate.
bool Localizer::decide(std::size_t b) {
  const int chosen = map_.edge_choice[b - 1];
  const Pose2 before = map_.map_from_keyframe[b - 1];
  std::size_t end = b + 1;
  while (end < b + kLocalization.localizer.look_ahead && edge_exists(end)) ++end;
  PlaceHypotheses places;
  int best = chosen;
  for (int k = 0; k < static_cast<int>(graph_.edges[b - 1].candidates.size()); ++k) {
    map_.edge_choice[b - 1] = k;
    if (places.add(verification_.lay(map_, b, end, b, before * edge_in_map(graph_, map_, b)))) best = k;
  }
  map_.edge_choice[b - 1] = places.is_sure() ? best : chosen;
  return places.is_sure();
}

void Localizer::get_lost() {
  state_.is_lost = true;
  forget_pending();
}

/// Tries each stretch between doubtful edges at all places where it may be. The keyframes before a stretch that is
/// placed stay a component of their own until the whole graph is optimised. So do those after a gap, where another
/// session starts or nothing matches, because more evidence is needed to join two sessions.
void Localizer::relocalize(std::size_t last) {
  const std::size_t lost = open_;
  for (std::size_t b = lost; b < last; ++b) {
    expect(b);
    map_.component[b] = lost;
  }
  for (std::size_t first = lost; first < last && !graph_.edges[first - 1].candidates.empty();) {
    const std::size_t end = end_of_stretch(first, last);
    const std::size_t end_of_placed = place(first, end);
    if (end_of_placed > first) {
      open_ = end_of_placed;
      state_ = {open_ < last, kLocalization.places.sure_of_place};
    }
    first = end_of_placed > first ? end_of_placed : end;
  }
}

std::size_t Localizer::end_of_stretch(std::size_t first, std::size_t last) const {
  std::size_t end = first + 1;
  while (end < last && edge_exists(end) && !is_in_doubt(end)) ++end;
  return end;
}

/// Tries to place keyframes `first` to before `last`. Returns the end of those that are placed.
std::size_t Localizer::place(std::size_t first, std::size_t last) {
  if (last - first < kLocalization.localizer.shortest) return first;
  PlaceHypotheses places;
  std::size_t tried = 0;
  for (const auto& [seed, map_from_seed] : candidates(first, last)) {
    if (places.has(seed - first, map_from_seed)) continue;
    if (++tried > kLocalization.localizer.most_tried) break;
    places.add(verification_.lay(map_, first, last, seed, map_from_seed));
  }
  for (std::size_t b = first; b < last; ++b) expect(b);
  if (!places.is_sure() || places.best().sure_end <= places.best().sure_begin) return first;
  accept(first, places.best());
  return first + places.best().sure_end;
}

/// Returns keyframes of the stretch with poses that they may have, by the edge to the first and by loop candidates.
std::vector<std::pair<std::size_t, Pose2>> Localizer::candidates(std::size_t first, std::size_t last) const {
  std::vector<std::pair<std::size_t, Pose2>> found;
  if (map_.component[first - 1] == verification_.active_component()) {
    for (const MatchCandidate& pose : graph_.edges[first - 1].candidates) {
      found.emplace_back(first, map_.map_from_keyframe[first - 1] * pose.ref_from_query);
    }
  }
  std::vector<const EdgeCandidate*> here;
  for (const EdgeCandidate& loop : loops_) {
    const bool is_here = first <= loop.b && loop.b < last && loop.a < first;
    if (is_here && map_.component[loop.a] == verification_.active_component() && !redundant_[loop.a])
      here.push_back(&loop);
  }
  std::stable_sort(here.begin(), here.end(),
                   [](const EdgeCandidate* one, const EdgeCandidate* other) { return one->score > other->score; });
  for (const EdgeCandidate* loop : here) {
    found.emplace_back(loop->b, map_.map_from_keyframe[loop->a] * loop->a_from_b);
  }
  return found;
}

/// Takes over the poses of a stretch as far as they are sure.
void Localizer::accept(std::size_t first, PlacedStretch stretch) {
  const std::size_t begin = first + stretch.sure_begin;
  for (std::size_t b = begin; b < first + stretch.sure_end; ++b) {
    map_.map_from_keyframe[b] = stretch.map_from_keyframe[b - first];
    map_.component[b] = verification_.active_component();
  }
  choose_candidate_as_in_map(begin);
  last_replaced_ = begin;
  for (std::size_t b = begin; b < first + stretch.sure_end; ++b) {
    if (stretch.redundant[b - first]) replace(b, std::move(*stretch.redundant[b - first]));
  }
}

/// Chooses the candidate of the edge to `b` that agrees with the poses of both keyframes, or cuts the edge.
void Localizer::choose_candidate_as_in_map(std::size_t b) {
  if (map_.component[b - 1] != verification_.active_component()) {
    map_.edge_choice[b - 1] = kCut;
    return;
  }
  const Pose2 in_map = inverse(map_.map_from_keyframe[b - 1]) * map_.map_from_keyframe[b];
  const std::vector<MatchCandidate>& candidates = graph_.edges[b - 1].candidates;
  map_.edge_choice[b - 1] = kCut;
  for (std::size_t k = 0; k < candidates.size() && map_.edge_choice[b - 1] == kCut; ++k) {
    if (!agrees(candidates[k].ref_from_query, in_map, kLocalization.redundancy.as_in_map)) continue;
    map_.edge_choice[b - 1] = static_cast<int>(k);
    map_.loop_constrained[b - 1] = true;
  }
}

}  // namespace shapemap
