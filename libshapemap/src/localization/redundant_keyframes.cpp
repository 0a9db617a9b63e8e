// SPDX-License-Identifier: GPL-3.0-or-later
#include "redundant_keyframes.hpp"

#include <algorithm>
#include <utility>

#include "localization_numbers.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/inference/map_score.hpp"
#include "shapemap/inference/map_search.hpp"
#include "shapemap/matching/pair_evidence.hpp"

namespace shapemap {
namespace {

/// Returns for each keyframe the earlier ones at its place, nearest first.
std::vector<std::vector<std::size_t>> earlier_at_place(const OptimizedMap& map, const KeyframeOptions& options) {
  std::vector<std::vector<std::pair<double, std::size_t>>> near(map.map_from_keyframe.size());
  for (const auto& [a, b] : near_pairs(map.map_from_keyframe, options.step_m)) {
    const Pose2 a_from_b = inverse(map.map_from_keyframe[a]) * map.map_from_keyframe[b];
    if (map.component[a] != map.component[b] || !is_within(a_from_b, options.near())) continue;
    near[b].emplace_back(a_from_b.translation().norm(), a);
  }
  std::vector<std::vector<std::size_t>> earlier(near.size());
  for (std::size_t b = 0; b < near.size(); ++b) {
    std::sort(near[b].begin(), near[b].end());
    for (const auto& [distance, a] : near[b]) earlier[b].push_back(a);
  }
  return earlier;
}

/// Marks the unknown keyframes, and those that follow or precede one closely.
std::vector<bool> near(const std::vector<bool>& is_unknown) {
  const std::size_t near = kLocalization.redundancy.in_doubt_near;
  std::vector<bool> result(is_unknown.size(), false);
  for (std::size_t b = 0; b < is_unknown.size(); ++b) {
    if (!is_unknown[b]) continue;
    const std::size_t end = std::min(b + near + 1, result.size());
    for (std::size_t i = b - std::min(b, near); i < end; ++i) result[i] = true;
  }
  return result;
}

}  // namespace

std::vector<ReplacementKeyframe> replacements_for(const KeyframeGraph& graph,
                                                  const std::vector<Pose2>& map_from_keyframe,
                                                  const ReplacementQuery& query, const RobustOptions& options) {
  const std::size_t b = query.keyframe;
  std::vector<ReplacementKeyframe> fitting;
  for (const std::size_t a : query.earlier) {
    if (fitting.size() == query.most) break;
    const Pose2 expected = inverse(map_from_keyframe[a]) * map_from_keyframe[b];
    const MatchCandidate pose =
        refined_candidate(*graph.keyframes[a].view, *graph.keyframes[b].view, expected, options.matcher.search);
    const bool is_as_in_map = agrees(expected, pose.ref_from_query, kLocalization.redundancy.as_in_map);
    if (is_as_in_map && shows_the_same(pose)) fitting.push_back({a, pose});
  }
  return fitting;
}

std::vector<bool> cullable_keyframes(const KeyframeGraph& graph, const OptimizedMap& map) {
  const std::size_t count = graph.keyframes.size();
  std::vector<bool> sure(graph.edges.size());
  for (std::size_t i = 0; i < sure.size(); ++i) {
    sure[i] = map.edge_choice[i] != kCut &&
              (map.loop_constrained[i] || stated_probability(graph.edges[i]) >= kLocalization.redundancy.sure_edge);
  }
  std::vector<bool> cullable(count, false);
  for (std::size_t i = 1; i + kLocalization.redundancy.keyframes_in_use < count; ++i) {
    cullable[i] = sure[i - 1] && sure[i] && graph.keyframes[i].sweep_views.empty();
  }
  return cullable;
}

RedundantKeyframes find_redundant_keyframes(const KeyframeGraph& graph, const OptimizedMap& map,
                                            const RobustOptions& options, int threads) {
  const std::vector<bool> cullable = cullable_keyframes(graph, map);
  const std::vector<std::vector<std::size_t>> earlier = earlier_at_place(map, options.keyframes);
  std::vector<std::vector<ReplacementKeyframe>> fitting(cullable.size());
  parallel_for(cullable.size(), threads, [&](std::size_t b) {
    if (cullable[b])
      fitting[b] = replacements_for(graph, map.map_from_keyframe,
                                    {b, earlier[b], kLocalization.redundancy.replacements_tried}, options);
  });
  RedundantKeyframes result;
  result.of_keyframe.resize(cullable.size());
  std::vector<bool> is_unknown(cullable.size(), false);
  for (std::size_t b = 0; b < cullable.size(); ++b) {
    if (!cullable[b]) continue;
    const auto is_long_before = [&](std::size_t a) { return a + kLocalization.redundancy.keyframes_in_use < b; };
    const bool again = std::any_of(earlier[b].begin(), earlier[b].end(), is_long_before);
    const bool known = std::any_of(fitting[b].begin(), fitting[b].end(), [&](const ReplacementKeyframe& candidate) {
      return is_long_before(candidate.keyframe);
    });
    is_unknown[b] =
        again && !known && fitting[b].size() < kLocalization.redundancy.replacements_tried;  // so that all were tried
    if (known) ++result.num_known;
    if (known || is_unknown[b]) ++result.num_again;
    for (const ReplacementKeyframe& candidate : fitting[b]) {
      if (result.of_keyframe[candidate.keyframe]) continue;  // it is culled itself
      result.of_keyframe[b] = candidate;
      break;
    }
  }
  result.is_in_doubt = near(is_unknown);
  for (std::size_t b = 0; b < cullable.size(); ++b) {
    if (result.is_in_doubt[b]) result.of_keyframe[b].reset();
  }
  return result;
}

bool RedundantKeyframes::are_of_right_map() const {
  return static_cast<double>(num_known) >= kLocalization.redundancy.right_map * static_cast<double>(num_again);
}

}  // namespace shapemap
