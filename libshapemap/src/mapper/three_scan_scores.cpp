// SPDX-License-Identifier: GPL-3.0-or-later
#include "three_scan_scores.hpp"

#include <algorithm>
#include <cmath>

#include "inference/inference_numbers.hpp"
#include "mapper_numbers.hpp"
#include "shapemap/core/parallel_for.hpp"

namespace shapemap {
namespace {

/// Returns the score of a pose by two scans that it was not found from. Little overlap is little evidence either way.
double three_scan_score(const Visibility& v) {
  const double total = std::max(v.total(), 1e-9);
  const ThreeScanWeights& weights = kMapper.three_scans;
  return weights.agree * std::log(weights.agree_offset + v.agree / total) +
         weights.crossed * std::log(weights.crossed_offset + v.crossed / total);
}

std::vector<std::vector<double>> three_scan_scores(const KeyframeGraph& graph, std::size_t first,
                                                   const RobustOptions& options) {
  const OdometryEdge& a_to_b = graph.edges[first];
  const OdometryEdge& b_to_c = graph.edges[first + 1];
  std::vector<std::vector<double>> scores = no_transition_scores(a_to_b, b_to_c);
  for (std::size_t i = 0; i < a_to_b.candidates.size(); ++i) {
    for (std::size_t j = 0; j < b_to_c.candidates.size(); ++j) {
      const Pose2 a_from_c = a_to_b.candidates[i].ref_from_query * b_to_c.candidates[j].ref_from_query;
      const Visibility seen = visibility(*graph.keyframes[first].view, *graph.keyframes[first + 2].view, a_from_c,
                                         options.matcher.search.visibility, {kInference.agreement.odometry_slack, 1});
      scores[i][j] = options.front_end.three_scan_weight * three_scan_score(seen);
    }
  }
  return scores;
}

}  // namespace

void set_three_scan_scores(const std::vector<std::size_t>& first, const RobustOptions& options, int threads,
                           KeyframeGraph& graph) {
  parallel_for(first.size(), threads, [&](std::size_t k) {
    graph.edges[first[k]].transition_scores = three_scan_scores(graph, first[k], options);
  });
}

void add_three_scan_scores(const RobustOptions& options, int threads, KeyframeGraph& graph) {
  std::vector<std::size_t> without;
  for (std::size_t i = 0; i + 1 < graph.edges.size(); ++i) {
    if (graph.edges[i].transition_scores.empty()) without.push_back(i);
  }
  set_three_scan_scores(without, options, threads, graph);
}

}  // namespace shapemap
