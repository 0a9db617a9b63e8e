// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "graph/keyframe_graph.hpp"
#include "shapemap/core/execution.hpp"
#include "shapemap/graph/closed_loop.hpp"
#include "shapemap/inference/robust_options.hpp"
#include "shapemap/loops/loop_clusters.hpp"

namespace shapemap {

/// A loop that was considered and is not closed.
struct RefusedLoop {
  ClosedLoop loop;  ///< between scans
  std::string why;  ///< one line of text
};

/// The poses of the keyframes, and the constraints on them.
struct OptimizedMap {
  std::vector<Pose2> map_from_keyframe;
  std::vector<int> edge_choice;        ///< of each edge: its candidate, or kCut
  std::vector<bool> loop_constrained;  ///< of each edge: whether loops hold its keyframes in place without it
  std::vector<std::size_t> component;  ///< of each keyframe: the first keyframe of its component
  std::vector<ClosedLoop> loops;       ///< between scans
  std::vector<RefusedLoop> refused_loops;
  /// These are all constraints between keyframes that the map was solved with. A map of odometry alone has none.
  std::vector<PoseConstraint> constraints;
};

/// Returns the constraints of the chosen candidates. Edges that are cut give none.
std::vector<PoseConstraint> edge_constraints(const KeyframeGraph& graph, const std::vector<int>& edge_choice);

/// This says what happens to an improbable edge that alone holds what comes after it.
enum class Improbable {
  kIsCut,
  kStays,  ///< verify_doubtful_edges() will judge it by all scans of both sides
};

/// Returns the map of odometry alone, in which errors add up. Improbable edges are cut.
OptimizedMap map_of_odometry(const KeyframeGraph& graph, const RobustOptions& options);

/// Returns the map with its loops closed, and all scans matched to all that see the same. When the observer asks to
/// stop, the map has the loops that were closed by then.
OptimizedMap optimized_map(const KeyframeGraph& graph, const std::vector<EdgeCandidate>& candidates,
                           Improbable improbable, const RobustOptions& options, const Execution& execution);

}  // namespace shapemap
