// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "map_hypothesis.hpp"
#include "shapemap/core/observer.hpp"

namespace shapemap {

/// Returns, for each node, the first node of those that the taken candidates and closed loops join it to.
inline std::vector<std::size_t> submaps_of(const MapObjective& problem, const MapHypothesis& map) {
  return connected_components(problem.num_nodes(), problem.constraints(map));
}

/// These search moves close the loops that raise the value of a map. They end early when the observer asks to stop.
class LoopMoves {
 public:
  LoopMoves(MapObjective& problem, const std::vector<LoopCluster>& clusters, const MapSearchOptions& options,
            RunObserver& observer)
      : problem_(problem), clusters_(clusters), options_(options), observer_(observer) {}

  /// Closes all loops that raise the value, strongest first.
  void close(MapHypothesis& map);
  /// Closes only the loops that agree with the map as it is.
  void close_all_agreeing(MapHypothesis& map);

 private:
  bool close_agreeing(MapHypothesis& map);
  bool can_join(const MapHypothesis& map, const std::vector<std::size_t>& submap, std::size_t k) const;
  bool join_submaps(MapHypothesis& map, std::size_t k) const;
  bool try_loop(MapHypothesis& map, std::size_t k);

  MapObjective& problem_;
  const std::vector<LoopCluster>& clusters_;
  const MapSearchOptions& options_;
  RunObserver& observer_;
};

}  // namespace shapemap
