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
  ClosedLoop loop;  ///< of scans
  std::string why;  ///< one line
};

/// Where the keyframes are, and what holds them there.
struct OptimizedMap {
  std::vector<Pose2> map_from_keyframe;
  std::vector<int> edge_choice;        ///< per link: which of its hypotheses; kCut: none
  std::vector<bool> loop_constrained;  ///< per link: its two keyframes stay where they are without it
  std::vector<std::size_t> component;  ///< per keyframe: the first of those that it hangs together with
  std::vector<ClosedLoop> loops;       ///< of positions
  std::vector<RefusedLoop> refused_loops;
  /// Of keyframes, all that the map was solved with. None where it is only the chain.
  std::vector<PoseConstraint> constraints;
};

/// What the links say by the hypotheses that are chosen, but for those that are cut.
std::vector<PoseConstraint> edge_constraints(const KeyframeGraph& graph, const std::vector<int>& edge_choice);

/// What becomes of a link that is improbable by itself, and alone holds what comes after it.
enum class Improbable {
  kIsCut,
  kStays,  ///< all scans of both sides will judge it: verify_doubtful_edges()
};

/// The chain as it is: errors add up. Improbable links are cut.
OptimizedMap map_of_odometry(const KeyframeGraph& graph, const RobustOptions& options);

/// The chain with its loops closed, and all scans aligned to all that see the same. When the observer asks to stop,
/// with the loops that are closed by then.
OptimizedMap optimized_map(const KeyframeGraph& graph, const std::vector<EdgeCandidate>& candidates,
                           Improbable improbable, const RobustOptions& options, const Execution& execution);

}  // namespace shapemap
