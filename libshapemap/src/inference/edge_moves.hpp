// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <set>
#include <tuple>
#include <vector>

#include "loop_moves.hpp"
#include "map_hypothesis.hpp"
#include "shapemap/core/observer.hpp"

namespace shapemap {

/// These search moves look into contradictions: a strong loop that does not fit, or a doubtful edge, may show that
/// another edge or loop is wrong. The search ends early when the observer asks to stop.
class EdgeMoves {
 public:
  EdgeMoves(MapObjective& problem, LoopMoves& closer, const GraphEvidence& evidence, const MapSearchOptions& options,
            RunObserver& observer)
      : problem_(problem),
        closer_(closer),
        edges_(evidence.edges),
        clusters_(evidence.clusters),
        options_(options),
        observer_(observer) {}

  /// Repairs the most doubtful edges first. Otherwise a wrong loop that is fitted by cutting a better edge would get in
  /// their way.
  void repair(MapHypothesis& best);

 private:
  void swing(MapHypothesis& map, std::size_t i, const Pose2& move) const;
  bool better_when_closed(MapHypothesis& trial, MapHypothesis& best, double hopeless);
  bool is_new(std::size_t edge, int choice, std::size_t loop);
  bool try_candidates(MapHypothesis& best, std::size_t i);
  bool try_cutting_for(MapHypothesis& best, std::size_t k);
  std::vector<std::size_t> doubtful_edges(std::size_t first, std::size_t last, std::size_t count) const;
  std::vector<std::size_t> changed_edges(const MapHypothesis& map) const;
  void repair_doubtful(MapHypothesis& best);

  MapObjective& problem_;
  LoopMoves& closer_;
  const std::vector<Edge>& edges_;
  const std::vector<LoopCluster>& clusters_;
  const MapSearchOptions& options_;
  RunObserver& observer_;
  double doubt_below_ = 0.0;                                   ///< less probable edges may be changed
  std::set<std::tuple<std::size_t, int, std::size_t>> tried_;  ///< changes of the best map that were tried
};

}  // namespace shapemap
