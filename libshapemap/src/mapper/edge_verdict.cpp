// SPDX-License-Identifier: GPL-3.0-or-later
#include "edge_verdict.hpp"

#include "shapemap/inference/map_search.hpp"

namespace shapemap {

void judge_link(const KeyframeChain& chain, const KeyframeMap& map, std::size_t link, const ConfidenceOptions& options,
                TraceSink* sink, PositionResult& outcome) {
  outcome.held_by_loops = map.held_by_loops[link];
  const std::size_t before = chain.keyframes[link].position_index;
  if (chain.keyframes[link].session != outcome.session) return;  // there is nothing to align to
  outcome.reference = before;
  const KeyframeLink& of = chain.links[link];
  const std::vector<PoseHypothesis>& hypotheses = of.hypotheses;
  const Choice& choice = of.choice;
  const bool is_cut = map.link_choice[link] == kCut;
  const std::size_t best = of.revised ? of.revised->hypothesis : choice.alternative;
  const std::size_t taken = is_cut ? best : static_cast<std::size_t>(map.link_choice[link]);
  const bool is_first_choice = taken == choice.alternative;
  double margin = choice.margin;
  if (!is_first_choice) margin = hypotheses[taken].score - hypotheses[choice.alternative].score;
  std::optional<double> probability;
  if (!hypotheses.empty()) {
    probability = of.revised ? of.revised->probability : probability_by_two_scans(of, taken, margin);
  }
  outcome.alignment = judged(hypotheses, taken, margin, options, probability);
  outcome.reason = outcome.alignment.reason;
  if (is_cut && !hypotheses.empty() && outcome.reason.empty()) {
    outcome.reason = outcome.held_by_loops ? "the rest of the map speaks against it"
                                           : "less probable than it takes not to split the map";
  }
  if (sink && !hypotheses.empty()) sink->on_choice({before, outcome.position_index, taken, margin});
}

}  // namespace shapemap
