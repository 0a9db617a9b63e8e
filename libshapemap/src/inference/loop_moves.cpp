// SPDX-License-Identifier: GPL-3.0-or-later
#include "loop_moves.hpp"
#include "inference_numbers.hpp"

#include <algorithm>

namespace shapemap {
namespace {

/// Returns the motion that brings the submap of the later node to where a loop has it.
Pose2 join(const MapHypothesis& map, const PoseConstraint& loop) {
  return map.map_from_node[loop.a] * loop.a_from_b * inverse(map.map_from_node[loop.b]);
}

}  // namespace

/// Closes the loops that agree with the map as it is.
bool LoopMoves::close_agreeing(MapHypothesis& map) {
  MapHypothesis trial = map;
  bool any = false;
  for (std::size_t k = 0; k < clusters_.size(); ++k) {
    if (trial.accepted[k] || clusters_[k].strength < kInference.objective.least_strength) continue;
    if (!is_within(problem_.off(trial, k), kInference.agreement.agrees)) continue;
    trial.accepted[k] = 1;
    any = true;
  }
  if (!any) return false;
  problem_.solve(trial);
  problem_.rate(trial);
  if (trial.value < map.value) return false;
  map = std::move(trial);
  return true;
}

/// Says whether loop `k` may decide the relative pose of two submaps.
bool LoopMoves::can_join(const MapHypothesis& map, const std::vector<std::size_t>& submap, std::size_t k) const {
  const LoopCluster& cluster = clusters_[k];
  const SearchNumbers& numbers = kInference.search;
  if (cluster.strength < numbers.joining_strength) return false;
  if (std::min(cluster.num_a, cluster.num_b) < numbers.joining_nodes) return false;
  const PoseConstraint& loop = problem_.best_member(k);
  const Pose2 move = join(map, loop);
  for (std::size_t other = 0; other < clusters_.size(); ++other) {
    if (clusters_[other].strength * numbers.joining_lead < cluster.strength) continue;
    const PoseConstraint& rival = problem_.best_member(other);
    const bool same_submaps = submap[rival.a] == submap[loop.a] && submap[rival.b] == submap[loop.b];
    if (!same_submaps) continue;
    const Pose2 predicted = inverse(map.map_from_node[rival.a]) * move * map.map_from_node[rival.b];
    if (!agrees(rival.a_from_b, predicted, kInference.agreement.contradicts)) return false;
  }
  return true;
}

/// Moves a submap to where a loop has it, unless the two are joined. Returns false if the loop may not decide that.
bool LoopMoves::join_submaps(MapHypothesis& map, std::size_t k) const {
  const PoseConstraint& loop = problem_.best_member(k);
  const std::vector<std::size_t> submap = submaps_of(problem_, map);
  if (submap[loop.a] == submap[loop.b]) return true;
  if (!can_join(map, submap, k)) return false;
  const Pose2 move = join(map, loop);
  for (std::size_t n = 0; n < problem_.num_nodes(); ++n) {
    if (submap[n] == submap[loop.b]) map.map_from_node[n] = move * map.map_from_node[n];
  }
  return true;
}

bool LoopMoves::try_loop(MapHypothesis& map, std::size_t k) {
  MapHypothesis trial = map;
  if (!join_submaps(trial, k)) return false;
  trial.accepted[k] = 1;
  problem_.solve(trial);
  const double without_scans = problem_.worth(k) - 0.5 * (trial.chi_square - map.chi_square);
  if (without_scans < -options_.trust_cap) return false;
  problem_.rate(trial);
  if (trial.value < map.value + options_.least_gain) return false;
  map = std::move(trial);
  return true;
}

void LoopMoves::close(MapHypothesis& map) {
  bool again = true;
  for (int round = 0; again && round < kInference.search.closing_rounds; ++round) {
    again = false;
    close_all_agreeing(map);
    for (std::size_t k = 0; k < clusters_.size() && observer_.keep_going(); ++k) {
      if (map.accepted[k] || clusters_[k].strength < kInference.objective.least_strength) continue;
      const Pose2 off = problem_.off(map, k);
      if (agrees(map.refused_off[k], off, kInference.agreement.agrees)) continue;
      if (try_loop(map, k)) {
        again = true;
        close_all_agreeing(map);
      } else {
        map.refused_off[k] = off;
      }
    }
  }
}

void LoopMoves::close_all_agreeing(MapHypothesis& map) {
  while (observer_.keep_going() && close_agreeing(map)) {
  }
}

}  // namespace shapemap
