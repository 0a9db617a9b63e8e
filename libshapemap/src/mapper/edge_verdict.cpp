// SPDX-License-Identifier: GPL-3.0-or-later
#include "edge_verdict.hpp"

#include "shapemap/inference/map_search.hpp"

namespace shapemap {

std::optional<EdgeChosen> judge_edge(const KeyframeGraph& graph, const OptimizedMap& map, std::size_t edge,
                                     const ConfidenceOptions& options, ScanResult& outcome) {
  outcome.loop_constrained = map.loop_constrained[edge];
  const std::size_t before = graph.keyframes[edge].scan_index;
  if (graph.keyframes[edge].session != outcome.session) return std::nullopt;  // there is nothing to match to
  outcome.reference = before;
  const OdometryEdge& of = graph.edges[edge];
  const std::vector<MatchCandidate>& candidates = of.candidates;
  const Choice& choice = of.choice;
  const bool is_cut = map.edge_choice[edge] == kCut;
  const std::size_t best = of.verified ? of.verified->candidate : choice.candidate;
  const std::size_t taken = is_cut ? best : static_cast<std::size_t>(map.edge_choice[edge]);
  const bool is_first_choice = taken == choice.candidate;
  double margin = choice.margin;
  if (!is_first_choice) margin = candidates[taken].score - candidates[choice.candidate].score;
  std::optional<double> probability;
  if (!candidates.empty()) {
    probability = of.verified ? of.verified->probability : probability_by_two_scans(of, taken, margin);
  }
  outcome.match = judged(candidates, taken, margin, options, probability);
  outcome.reason = outcome.match.reason;
  if (is_cut && !candidates.empty() && outcome.reason.empty()) {
    outcome.reason = outcome.loop_constrained ? "the rest of the map speaks against it"
                                              : "less probable than it takes not to split the map";
  }
  if (candidates.empty()) return std::nullopt;
  return EdgeChosen{before, outcome.scan_index, taken, margin};
}

}  // namespace shapemap
