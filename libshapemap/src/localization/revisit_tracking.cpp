// SPDX-License-Identifier: GPL-3.0-or-later
#include "revisit_tracking.hpp"

#include <algorithm>
#include <utility>

#include "localization_numbers.hpp"
#include "shapemap/inference/map_search.hpp"

namespace shapemap {
namespace {

/// Adds the edges that the map does not have, with the candidates that the graph chose.
void add_edges(const KeyframeGraph& graph, OptimizedMap& map) {
  for (std::size_t i = map.edge_choice.size(); i < graph.edges.size(); ++i) {
    const OdometryEdge& edge = graph.edges[i];
    map.edge_choice.push_back(edge.candidates.empty() ? kCut : static_cast<int>(edge.choice.candidate));
    map.loop_constrained.push_back(false);
  }
}

void add_edge_constraints(const KeyframeGraph& graph, std::size_t first, OptimizedMap& map) {
  for (std::size_t i = first; i < graph.edges.size(); ++i) {
    if (map.edge_choice[i] == kCut) continue;
    map.constraints.push_back(edge_constraint(graph, i, static_cast<std::size_t>(map.edge_choice[i])));
  }
}

/// Returns the last of the first `end` keyframes whose pose is certain because its component has others.
std::size_t last_certain(const OptimizedMap& map, std::size_t end) {
  std::vector<std::size_t> size(map.component.size(), 0);
  for (const std::size_t component : map.component) ++size[component];
  std::size_t last = end - 1;
  while (last > 0 && size[map.component[last]] == 1) --last;
  return last;
}

}  // namespace

void RevisitTracker::start(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t num_settled) {
  const std::size_t last = last_certain(map, num_settled);
  state_ = {};
  state_.is_lost = last + 1 < num_settled;
  active_scan_ = graph.keyframes[map.component[last]].scan_index;
  renew(map, graph.keyframes.size() - num_settled);
}

RevisitTracker::Followed RevisitTracker::follow(const KeyframeGraph& graph, const std::vector<EdgeCandidate>& loops) {
  const std::size_t first = settled_.map_from_keyframe.size();
  const std::size_t count = graph.keyframes.size();
  const std::size_t last = count - std::min(count, kLocalization.redundancy.keyframes_in_use);
  Followed result;
  result.map = settled_;
  add_edges(graph, result.map);
  result.map.map_from_keyframe.resize(count);
  for (std::size_t i = first; i < count; ++i) result.map.component.push_back(i);
  const std::size_t active_component = result.map.component[keyframe_of(graph, active_scan_)];
  Localizer localizer(graph, options_, {active_component, first, state_}, loops, result.map);
  result.num_followed = localizer.go(std::max(first, last));
  for (std::size_t b = result.num_followed; b < count; ++b) localizer.expect(b);
  add_edge_constraints(graph, first - 1, result.map);
  state_ = localizer.state();
  result.redundant = std::move(localizer.redundant());
  // An edge that may still change must not be fixed as it is in the map, as culling the keyframe before it would do.
  if (state_.is_lost) result.redundant[result.num_followed - 1].reset();
  const std::vector<bool> cullable = cullable_keyframes(graph, result.map);
  for (std::size_t b = first; b < count; ++b) {
    if (!cullable[b]) result.redundant[b].reset();
  }
  return result;
}

void RevisitTracker::renew(OptimizedMap map, std::size_t num_open) {
  const std::size_t count = map.map_from_keyframe.size() - num_open;
  map.map_from_keyframe.resize(count);
  map.component.resize(count);
  map.edge_choice.resize(count - 1);
  map.loop_constrained.resize(count - 1);
  const auto is_open = [&](const PoseConstraint& constraint) { return std::max(constraint.a, constraint.b) >= count; };
  map.constraints.erase(std::remove_if(map.constraints.begin(), map.constraints.end(), is_open), map.constraints.end());
  settled_ = std::move(map);
}

}  // namespace shapemap
