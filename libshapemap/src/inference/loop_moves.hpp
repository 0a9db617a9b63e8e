// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "map_hypothesis.hpp"
#include "shapemap/core/observer.hpp"

namespace shapemap {

/// Per node: the first of those that what was decided joins it to.
inline std::vector<std::size_t> pieces_of(const LoopProblem& problem, const LoopChoice& map) {
  return connected_parts(problem.num_nodes(), problem.constraints(map));
}

/// Closes the loops that gain. Stops early when the observer asks to.
class LoopCloser {
 public:
  LoopCloser(LoopProblem& problem, const std::vector<LoopCluster>& clusters, const MapSearchOptions& options,
             RunObserver& observer)
      : problem_(problem), clusters_(clusters), options_(options), observer_(observer) {}

  /// Closes all loops that gain, strongest first.
  void close(LoopChoice& map);
  /// Only those that the map agrees with as it is.
  void close_all_agreeing(LoopChoice& map);

 private:
  bool close_agreeing(LoopChoice& map);
  bool can_join(const LoopChoice& map, const std::vector<std::size_t>& piece, std::size_t k) const;
  bool join_pieces(LoopChoice& map, std::size_t k) const;
  bool try_loop(LoopChoice& map, std::size_t k);

  LoopProblem& problem_;
  const std::vector<LoopCluster>& clusters_;
  const MapSearchOptions& options_;
  RunObserver& observer_;
};

}  // namespace shapemap
