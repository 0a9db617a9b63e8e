// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion_rescoring.hpp"

#include <algorithm>
#include <set>

#include "shapemap/core/parallel_for.hpp"
#include "shapemap/matching/candidate_order.hpp"
#include "three_scan_scores.hpp"

namespace shapemap {
namespace {

void rescore(const MotionPrior& prior, const RobustOptions& options, std::size_t i, KeyframeGraph& graph) {
  const MatchSearchOptions& search = options.matcher.search;
  std::vector<MatchCandidate>& known = graph.edges[i].candidates;
  for (MatchCandidate& candidate : known) candidate.score -= prior.surprise(candidate.ref_from_query);
  std::stable_sort(known.begin(), known.end(), is_more_likely);
  if (match_probability(known.front(), lead_of_first(known)) < options.map_search.doubt_below) {
    const auto more = find_usual_candidates(*graph.keyframes[i].view, *graph.keyframes[i + 1].view, search, prior);
    known.insert(known.end(), more.begin(), more.end());
    known = best_distinct(std::move(known), search.candidates.kept);
  }
  graph.edges[i].num_own = known.size();
}

}  // namespace

std::vector<std::size_t> rescore_by_motion(const RobustOptions& options, int threads, KeyframeGraph& graph) {
  const MotionPrior prior = motion_prior(graph);
  std::vector<std::size_t> completed;
  std::vector<std::size_t> rescored;
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const OdometryEdge& edge = graph.edges[i];
    if (edge.is_complete || edge.culled_covariance) continue;
    completed.push_back(i);
    if (!edge.candidates.empty() && !graph.keyframes[i + 1].expected) rescored.push_back(i);
  }
  parallel_for(rescored.size(), threads, [&](std::size_t k) { rescore(prior, options, rescored[k], graph); });
  std::set<std::size_t> pairs;  // the first of each two successive edges of which one has changed
  for (const std::size_t i : rescored) {
    if (i > 0) pairs.insert(i - 1);
    if (i + 1 < graph.edges.size()) pairs.insert(i);
  }
  set_three_scan_scores({pairs.begin(), pairs.end()}, options, threads, graph);
  for (const std::size_t i : completed) graph.edges[i].is_complete = true;
  return completed;
}

}  // namespace shapemap
