// SPDX-License-Identifier: GPL-3.0-or-later
#include "edge_moves.hpp"
#include "inference_numbers.hpp"

#include <algorithm>
#include <utility>

namespace shapemap {
/// Moves the nodes after edge `i`, up to the next cut, and opens the loops that the moved map contradicts.
void EdgeMoves::swing(MapHypothesis& map, std::size_t i, const Pose2& move) const {
  std::size_t n = i + 1;
  do {
    map.map_from_node[n] = move * map.map_from_node[n];
    ++n;
  } while (n < problem_.num_nodes() && map.edge_choice[n - 1] != kCut);
  for (std::size_t k = 0; k < clusters_.size(); ++k) {
    if (map.accepted[k] && !is_within(problem_.off(map, k), kInference.agreement.contradicts)) map.accepted[k] = 0;
  }
}

/// Closes the loops of a changed map, and keeps the change if the map then has a larger value.
bool EdgeMoves::better_when_closed(MapHypothesis& trial, MapHypothesis& best, double hopeless) {
  problem_.solve(trial);
  problem_.rate(trial);
  closer_.close_all_agreeing(trial);
  if (trial.value < best.value - hopeless) return false;
  closer_.close(trial);
  if (trial.value < best.value + options_.least_gain) return false;
  best = std::move(trial);
  tried_.clear();
  return true;
}

/// Says whether a change of the best map has not been tried yet. It is not tried again until the best map changes.
bool EdgeMoves::is_new(std::size_t edge, int choice, std::size_t loop) {
  return tried_.insert({edge, choice, loop}).second;
}

bool EdgeMoves::try_candidates(MapHypothesis& best, std::size_t i) {
  const auto count = static_cast<int>(edges_[i].candidates.size());
  for (int choice = 0; choice < count && observer_.keep_going(); ++choice) {
    if (choice == best.edge_choice[i] || !is_new(i, choice, clusters_.size())) continue;
    MapHypothesis trial = best;
    trial.edge_choice[i] = choice;
    const Pose2& a_from_b = edges_[i].candidates[static_cast<std::size_t>(choice)].a_from_b;
    swing(trial, i, trial.map_from_node[i] * a_from_b * inverse(trial.map_from_node[i + 1]));
    const SearchNumbers& numbers = kInference.search;
    const double hopeless = best.edge_choice[i] != 0 ? numbers.hopeless_loop : numbers.hopeless_edge;
    if (better_when_closed(trial, best, hopeless)) return true;
  }
  return false;
}

/// If a strong loop does not fit, one of the edges along it may be wrong.
bool EdgeMoves::try_cutting_for(MapHypothesis& best, std::size_t k) {
  const PoseConstraint& loop = problem_.best_member(k);
  const std::vector<std::size_t> submap = submaps_of(problem_, best);
  if (submap[loop.a] != submap[loop.b]) return false;
  const std::vector<std::size_t> doubtful = doubtful_edges(loop.a, loop.b, kInference.search.doubtful_per_loop);
  for (const std::size_t i : doubtful) {
    if (best.edge_choice[i] == kCut || !observer_.keep_going() || !is_new(i, kCut, k)) continue;
    MapHypothesis trial = best;
    trial.edge_choice[i] = kCut;
    swing(trial, i, trial.map_from_node[loop.a] * loop.a_from_b * inverse(trial.map_from_node[loop.b]));
    trial.accepted[k] = 1;
    if (better_when_closed(trial, best, kInference.search.hopeless_loop)) return true;
  }
  return false;
}

/// Returns the least probable edges from node `first` to node `last`.
std::vector<std::size_t> EdgeMoves::doubtful_edges(std::size_t first, std::size_t last, std::size_t count) const {
  std::vector<std::size_t> doubtful;
  for (std::size_t i = first; i < last; ++i) {
    if (edges_[i].exists() && edges_[i].probability < doubt_below_) doubtful.push_back(i);
  }
  std::stable_sort(doubtful.begin(), doubtful.end(),
                   [&](std::size_t i, std::size_t j) { return edges_[i].probability < edges_[j].probability; });
  doubtful.resize(std::min(doubtful.size(), count));
  return doubtful;
}

/// Returns the edges that do not take the candidate of the odometry.
std::vector<std::size_t> EdgeMoves::changed_edges(const MapHypothesis& map) const {
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (edges_[i].exists() && map.edge_choice[i] != 0) changed.push_back(i);
  }
  return changed;
}

void EdgeMoves::repair(MapHypothesis& best) {
  for (const double doubt_below : {kInference.search.very_doubtful * options_.doubt_below, options_.doubt_below}) {
    doubt_below_ = doubt_below;
    repair_doubtful(best);
  }
}

void EdgeMoves::repair_doubtful(MapHypothesis& best) {
  bool better = true;
  for (int round = 0; better && round < kInference.search.repair_rounds; ++round) {
    better = false;
    int left = options_.repairs;
    for (std::size_t k = 0; k < clusters_.size() && left > 0; ++k) {
      if (best.accepted[k] || clusters_[k].strength < kInference.search.strong_loop) continue;
      --left;
      better = try_cutting_for(best, k) || better;
    }
    for (const std::size_t i : changed_edges(best)) better = try_candidates(best, i) || better;
    for (const std::size_t i : doubtful_edges(0, edges_.size(), static_cast<std::size_t>(options_.repairs))) {
      if (best.edge_choice[i] == 0) better = try_candidates(best, i) || better;
    }
  }
}

}  // namespace shapemap
