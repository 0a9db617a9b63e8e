// SPDX-License-Identifier: GPL-3.0-or-later
#include "place_verification.hpp"

#include <algorithm>
#include <utility>

#include "inference/inference_numbers.hpp"
#include "localization_numbers.hpp"
#include "shapemap/inference/map_search.hpp"

namespace shapemap {
const Pose2& edge_in_map(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t b) {
  return graph.edges[b - 1].candidates[static_cast<std::size_t>(map.edge_choice[b - 1])].ref_from_query;
}

Pose2 pose_by(const OptimizedMap& map, const ReplacementKeyframe& replacement) {
  return map.map_from_keyframe[replacement.keyframe] * replacement.pose.ref_from_query;
}

PlaceEvidence PlaceVerification::look(const OptimizedMap& map, std::size_t b, std::size_t end) const {
  const std::vector<std::size_t> there = at_place(map, b, end);
  std::vector<ReplacementKeyframe> found = replacements_for(graph_, map.map_from_keyframe, {b, there, 1}, options_);
  // The keyframes just before `b` show the same, or do not, at whatever place the two are.
  const auto tells = [&](std::size_t a) { return a + kLocalization.redundancy.keyframes_in_use < b; };
  if (!found.empty())
    return {std::move(found.front()), tells(found.front().keyframe) ? kLocalization.places.known_tells : 0.0};
  return {std::nullopt, std::any_of(there.begin(), there.end(), tells) ? kLocalization.places.unknown_tells : 0.0};
}

PlacedStretch PlaceVerification::lay(OptimizedMap& map, std::size_t first, std::size_t last, std::size_t seed,
                                     const Pose2& map_from_seed) const {
  PlacedStretch laid;
  laid.redundant.resize(last - first);
  const double apart_m = kInference.search.components_apart_m;
  laid.map_from_keyframe.assign(last - first, {apart_m, apart_m, 0.0});
  laid.sure_begin = laid.sure_end = seed - first;
  double log_odds = kLocalization.places.sure_of_place;  // evidence along one direction from the seed
  const auto lay_one = [&](std::size_t b, const Pose2& expected) {
    map.map_from_keyframe[b] = expected;
    PlaceEvidence seen = look(map, b, first);
    laid.log_odds += seen.log_odds;
    log_odds = std::min(kLocalization.places.sure_of_place, log_odds + seen.log_odds);
    if (seen.replacement) map.map_from_keyframe[b] = pose_by(map, *seen.replacement);
    laid.map_from_keyframe[b - first] = map.map_from_keyframe[b];
    laid.redundant[b - first] = std::move(seen.replacement);
  };
  lay_one(seed, map_from_seed);
  const double at_seed = log_odds;
  for (std::size_t b = seed + 1; log_odds >= 0.0; ++b) {
    if (log_odds == kLocalization.places.sure_of_place) laid.sure_end = b - first;
    if (b == last) break;
    lay_one(b, map.map_from_keyframe[b - 1] * edge_in_map(graph_, map, b));
  }
  log_odds = at_seed;
  for (std::size_t b = seed; log_odds >= 0.0; --b) {
    if (log_odds == kLocalization.places.sure_of_place) laid.sure_begin = b - first;
    if (b == first) break;
    lay_one(b - 1, map.map_from_keyframe[b] * inverse(edge_in_map(graph_, map, b)));
  }
  return laid;
}

/// Returns the keyframes nearest to the expected pose of `b`, without the excluded ones.
std::vector<std::size_t> PlaceVerification::at_place(const OptimizedMap& map, std::size_t b, std::size_t end) const {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t a = 0; a < end; ++a) {
    if (map.component[a] != active_component_ || is_excluded_[a]) continue;
    const Pose2 a_from_b = inverse(map.map_from_keyframe[a]) * map.map_from_keyframe[b];
    if (is_within(a_from_b, options_.keyframes.near())) {
      near.emplace_back(a_from_b.translation().norm(), a);
    }
  }
  std::sort(near.begin(), near.end());
  std::vector<std::size_t> nearest;
  for (std::size_t k = 0; k < std::min(kLocalization.redundancy.replacements_tried, near.size()); ++k)
    nearest.push_back(near[k].second);
  return nearest;
}

}  // namespace shapemap
