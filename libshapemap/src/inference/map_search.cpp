// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/inference/map_search.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <system_error>

#include "edge_moves.hpp"
#include "inference_numbers.hpp"
#include "loop_moves.hpp"
#include "map_hypothesis.hpp"
#include "submap_merging.hpp"

namespace shapemap {
namespace {

/// An observer may only be asked from one thread, so its wish to stop is recorded here for the others.
class StopSign : public RunObserver {
 public:
  explicit StopSign(RunObserver& observer) : observer_(observer) {}
  bool keep_going() override {
    if (!observer_.keep_going()) stopped_ = true;
    return !stopped_;
  }

  class Reader : public RunObserver {
   public:
    explicit Reader(const StopSign& sign) : sign_(sign) {}
    bool keep_going() override { return !sign_.stopped_; }

   private:
    const StopSign& sign_;
  };

 private:
  RunObserver& observer_;
  std::atomic<bool> stopped_{false};
};

/// Returns what another thread computes. The observer is asked meanwhile, so that the other thread learns when to stop.
MapHypothesis waited_for(std::future<MapHypothesis>& result, StopSign& stop) {
  constexpr std::chrono::milliseconds kPatience{20};
  while (result.wait_for(kPatience) == std::future_status::timeout) stop.keep_going();
  return result.get();
}

/// Returns the best map of several runs of submap merging. It ends when several runs in a row bring no gain.
MapHypothesis merged(MapObjective& problem, const GraphEvidence& evidence, const std::vector<Pose2>& map_of_odometry,
                     const MapSearchOptions& options, RunObserver& observer) {
  MapHypothesis best;
  int in_vain = 0;
  for (int variant = 0; variant < options.assemblies && in_vain < kInference.search.assemblies_in_vain; ++variant) {
    if (variant > 0 && !observer.keep_going()) break;
    MapHypothesis trial = problem.of_map(
        merged_submaps({evidence.edges, evidence.loops, map_of_odometry}, problem.score(), options, variant, observer));
    const double least_gain = std::max(options.least_gain, kInference.search.least_gain_share * std::abs(best.value));
    const bool is_better = variant == 0 || trial.value > best.value + least_gain;
    in_vain = is_better ? 0 : in_vain + 1;
    if (is_better) best = std::move(trial);
  }
  return best;
}

}  // namespace

MapSolution search_map(const GraphEvidence& evidence, const VisibilityOptions& visibility,
                       const MapSearchOptions& options, const Execution& execution) {
  const std::vector<LoopCluster>& clusters = evidence.clusters;
  // Each objective has its own score, so that neither result depends on how far the other has come.
  MapObjective of_chain(evidence, visibility, options, 1);
  MapObjective problem(evidence, visibility, options, execution.threads);
  StopSign stop(execution.observer);
  const MapHypothesis chain = of_chain.chain_alone();
  const auto closed_chain = [&](RunObserver& asked) {
    MapHypothesis closed = chain;
    LoopMoves(of_chain, clusters, options, asked).close(closed);
    return closed;
  };
  StopSign::Reader reader(stop);
  std::future<MapHypothesis> meanwhile;
  try {
    if (execution.threads != 1) meanwhile = std::async(std::launch::async, closed_chain, std::ref(reader));
  } catch (const std::system_error&) {
    // If no thread can be started, the work is done afterwards.
  }
  LoopMoves closer(problem, clusters, options, stop);
  MapHypothesis best = merged(problem, evidence, chain.map_from_node, options, stop);
  closer.close(best);
  MapHypothesis other = meanwhile.valid() ? waited_for(meanwhile, stop) : closed_chain(stop);
  if (other.value > best.value) best = std::move(other);
  EdgeMoves(problem, closer, evidence, options, stop).repair(best);
  MapSolution solution;
  solution.component = connected_components(evidence.views.size(), problem.constraints(best));
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    if (best.accepted[k]) solution.accepted.push_back(k);
  }
  solution.map_from_node = std::move(best.map_from_node);
  solution.edge_choice = std::move(best.edge_choice);
  solution.value = best.value;
  return solution;
}

}  // namespace shapemap
