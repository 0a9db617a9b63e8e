// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/loops/loop_detection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "graph/graph_numbers.hpp"
#include "loops_numbers.hpp"
#include "shapemap/core/errors.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/loops/place_descriptor.hpp"
#include "shapemap/matching/match_probability.hpp"

namespace shapemap {
namespace {

/// The observer is asked after each block of so many pairs. The number changes no result.
constexpr std::size_t kBlock = 64;

struct Pair {
  std::size_t a;
  std::size_t b;
};

/// Most pairs have little in common, and the search would try all rotations on each of them.
MatchSearchOptions without_all_rotations(MatchSearchOptions search) {
  search.candidates.all_rotations_below = -std::numeric_limits<double>::infinity();
  return search;
}

/// Reduces the effort for very many pairs. A match that is missed is made up for by other scans of the same stretches.
MatchSearchOptions quick(MatchSearchOptions search) {
  search.candidates.rotation_peaks = std::max(1, search.candidates.rotation_peaks * 3 / 4);
  search.candidates.shape_segments = 0;
  search.candidates.refined = std::max(1, search.candidates.refined / 2);
  search.voting.peaks = std::max(1, search.voting.peaks / 2);
  return search;
}

/// These settings say how pairs are matched, and which candidates are kept.
struct PairSearch {
  MatchSearchOptions options;
  SearchKind kind;
  std::size_t most_poses;  ///< largest number of candidates of each pair
  double least_probability;
  Execution execution;
  MatchCache* store;
};

/// Returns the log odds that the two scans are of one place, and that the match has its position. A match that leaves a
/// direction unconstrained says little about the position.
double log_odds_of_place(double probability, const Eigen::Matrix3d& covariance) {
  const double p = std::clamp(probability, 1e-9, 1.0 - 1e-9);
  return log_odds_of(p) - std::log(std::max(1.0, worst_deviation_m(covariance) / kGraph.steps.held_m));
}

std::vector<EdgeCandidate> aligned(const NodeViews& views, const Pair& pair, const PairSearch& search) {
  const std::vector<MatchCandidate> poses =
      find_candidates(*views[pair.a], *views[pair.b], search.options, {pair.a, pair.b, search.kind}, search.store);
  std::vector<EdgeCandidate> found;
  for (std::size_t k = 0; k < std::min(search.most_poses, poses.size()); ++k) {
    const double margin = k == 0 ? lead_of_first(poses) : poses[k].score - poses[0].score;
    const double probability = match_probability(poses[k], margin);
    if (probability < search.least_probability) continue;
    const Eigen::Matrix3d covariance = pose_covariance(poses[k].fit);
    found.push_back({pair.a, pair.b, poses[k].ref_from_query, covariance, log_odds_of_place(probability, covariance)});
  }
  return found;
}

/// Adds the candidates of `pairs` to `all`, in order. Throws Interrupted when the observer asks to stop.
void align_all(const NodeViews& views, const std::vector<Pair>& pairs, const PairSearch& search,
               std::vector<EdgeCandidate>& all) {
  RunObserver& observer = search.execution.observer;
  for (std::size_t first = 0; first < pairs.size(); first += kBlock) {
    if (!observer.keep_going()) throw Interrupted();
    const std::size_t count = std::min(kBlock, pairs.size() - first);
    std::vector<std::vector<EdgeCandidate>> found(count);
    parallel_for(count, search.execution.threads,
                 [&](std::size_t i) { found[i] = aligned(views, pairs[first + i], search); });
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    observer.on_progress(first + count, pairs.size());
  }
}

}  // namespace

std::vector<EdgeCandidate> likely_loops(const NodeViews& views, std::size_t first, const LoopSearch& search) {
  const LoopDetectionOptions& options = search.detection;
  const int threads = search.execution.threads;
  std::vector<PlaceDescriptor> descriptors(views.size());
  parallel_for(views.size(), threads, [&](std::size_t i) { descriptors[i] = place_descriptor(*views[i]); });
  PlaceIndex index;
  for (const PlaceDescriptor& descriptor : descriptors) index.add(descriptor);

  const auto shortest = static_cast<std::size_t>(options.shortest_loop);
  const auto count = static_cast<std::size_t>(options.likely_places);
  std::vector<std::vector<LikelyPlace>> places(views.size());
  parallel_for(views.size(), threads, [&](std::size_t b) {
    if (b >= std::max(first, shortest)) places[b] = index.most_alike(b, b - shortest + 1, count);
  });
  std::vector<Pair> pairs;
  for (std::size_t b = 0; b < views.size(); ++b) {
    for (const LikelyPlace& place : places[b]) pairs.push_back({place.node, b});
  }
  const PairSearch quickly{quick(without_all_rotations(search.matching)),
                           SearchKind::kLoop,
                           kLoops.detection.poses_per_pair,
                           options.least_probability,
                           search.execution,
                           search.store};
  std::vector<EdgeCandidate> found;
  try {
    align_all(views, pairs, quickly, found);
  } catch (const Interrupted&) {  // The candidates found so far are of use.
  }
  return found;
}

std::vector<EdgeCandidate> cross_edge_matches(const NodeViews& views, const std::vector<std::size_t>& edges,
                                              const LoopSearch& search) {
  const std::size_t nodes = kLoops.detection.cross_edge_nodes;
  std::vector<Pair> pairs;
  for (const std::size_t edge : edges) {
    for (std::size_t a = edge + 1 - std::min(nodes, edge + 1); a <= edge; ++a) {
      for (std::size_t b = edge + 1; b < std::min(views.size(), edge + 1 + nodes); ++b) pairs.push_back({a, b});
    }
  }
  const PairSearch thoroughly{without_all_rotations(search.matching),
                              SearchKind::kMultiReference,
                              kLoops.detection.poses_per_cross_edge_pair,
                              0.0,
                              search.execution,
                              search.store};
  std::vector<EdgeCandidate> found;
  align_all(views, pairs, thoroughly, found);
  return found;
}

}  // namespace shapemap
