// SPDX-License-Identifier: GPL-3.0-or-later
#include "place_verification.hpp"

#include <algorithm>
#include <utility>

#include "shapemap/inference/map_search.hpp"

namespace shapemap {
namespace {

/// As if at the right place 95 % of keyframes were known, and at one that looks alike 60 %. (At the right place it is
/// nearly all of them; but things are moved.)
constexpr double kKnownTells = 0.5;
constexpr double kUnknownTells = -2.0;

}  // namespace

const Pose2& edge_in_map(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t b) {
  return graph.edges[b - 1].candidates[static_cast<std::size_t>(map.edge_choice[b - 1])].ref_from_query;
}

Pose2 pose_by(const OptimizedMap& map, const ReplacementKeyframe& replacement) {
  return map.map_from_keyframe[replacement.keyframe] * replacement.pose.ref_from_query;
}

PlaceEvidence PlaceVerification::look(const OptimizedMap& map, std::size_t b, std::size_t end) const {
  const std::vector<std::size_t> there = at_place(map, b, end);
  std::vector<ReplacementKeyframe> found = replacements_for(graph_, map.map_from_keyframe, b, there, 1, options_);
  // Those just before it show the same, or do not, wherever the two are.
  const auto tells = [&](std::size_t a) { return a + kKeyframesInUse < b; };
  if (!found.empty()) return {std::move(found.front()), tells(found.front().keyframe) ? kKnownTells : 0.0};
  return {std::nullopt, std::any_of(there.begin(), there.end(), tells) ? kUnknownTells : 0.0};
}

PlacedStretch PlaceVerification::lay(OptimizedMap& map, std::size_t first, std::size_t last, std::size_t seed,
                                     const Pose2& map_from_seed) const {
  PlacedStretch laid;
  laid.redundant.resize(last - first);
  laid.map_from_keyframe.assign(last - first, {kComponentsApart_m, kComponentsApart_m, 0.0});
  laid.sure_begin = laid.sure_end = seed - first;
  double log_odds = kSureOfPlace;  // of one way from the seed
  const auto lay_one = [&](std::size_t b, const Pose2& expected) {
    map.map_from_keyframe[b] = expected;
    PlaceEvidence seen = look(map, b, first);
    laid.log_odds += seen.log_odds;
    log_odds = std::min(kSureOfPlace, log_odds + seen.log_odds);
    if (seen.replacement) map.map_from_keyframe[b] = pose_by(map, *seen.replacement);
    laid.map_from_keyframe[b - first] = map.map_from_keyframe[b];
    laid.redundant[b - first] = std::move(seen.replacement);
  };
  lay_one(seed, map_from_seed);
  const double at_seed = log_odds;
  for (std::size_t b = seed + 1; log_odds >= 0.0; ++b) {
    if (log_odds == kSureOfPlace) laid.sure_end = b - first;
    if (b == last) break;
    lay_one(b, map.map_from_keyframe[b - 1] * edge_in_map(graph_, map, b));
  }
  log_odds = at_seed;
  for (std::size_t b = seed; log_odds >= 0.0; --b) {
    if (log_odds == kSureOfPlace) laid.sure_begin = b - first;
    if (b == first) break;
    lay_one(b - 1, map.map_from_keyframe[b] * inverse(edge_in_map(graph_, map, b)));
  }
  return laid;
}

/// Of those that stay, the nearest to where `b` is expected.
std::vector<std::size_t> PlaceVerification::at_place(const OptimizedMap& map, std::size_t b, std::size_t end) const {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t a = 0; a < end; ++a) {
    if (map.component[a] != active_component_ || is_gone_[a]) continue;
    const Pose2 a_from_b = inverse(map.map_from_keyframe[a]) * map.map_from_keyframe[b];
    if (is_within(a_from_b, options_.keyframes.step_m, options_.keyframes.turn_rad)) {
      near.emplace_back(a_from_b.translation().norm(), a);
    }
  }
  std::sort(near.begin(), near.end());
  std::vector<std::size_t> nearest;
  for (std::size_t k = 0; k < std::min(kReplacementsTried, near.size()); ++k) nearest.push_back(near[k].second);
  return nearest;
}

}  // namespace shapemap
