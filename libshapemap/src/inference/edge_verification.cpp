// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/inference/edge_verification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "graph/graph_numbers.hpp"
#include "inference_numbers.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/graph/pose_graph.hpp"
#include "shapemap/inference/map_score.hpp"
#include "shapemap/inference/map_search.hpp"
#include "submaps.hpp"

namespace shapemap {
namespace {

/// Returns the worth of a candidate by its own two scans, and by whether the map has it.
double worth_by_itself(const Edge& doubt, std::size_t k) {
  const EdgeCandidate& candidate = doubt.candidates[k];
  const VerificationWeights& weights = kInference.verification_weights;
  return weights.per_score * std::max(weights.least_score, candidate.score) +
         weights.per_log_deviation * std::log1p(candidate.best_deviation_m) + (k == 0 ? weights.of_map : 0.0);
}

double worth_of_none(const Edge& doubt) {
  const VerificationWeights& weights = kInference.verification_weights;
  return weights.none_of_them + weights.none_per_insufficient_view * doubt.insufficient_view;
}

bool is_same(const Pose2& a, const Pose2& b) { return agrees(a, b, kInference.agreement.same_candidate); }

/// Returns how right candidate `one` is when `other` is true. A place is right or wrong, but along a corridor a
/// candidate slides, and is less right the farther it is off.
double share_right(const EdgeCandidate& one, const Pose2& other) {
  if (is_same(one.a_from_b, other)) return 1.0;
  const double deviations = deviations_off({0, 0, one.a_from_b, one.covariance, 0.0}, other);
  return std::max(0.0, 1.0 - deviations / kGraph.same_place.deviations);
}

/// Returns the best candidate by `worths`, and its probability against all others and none. Where its scans do not
/// constrain it along a corridor, it is also right if a place to which it may slide is.
VerifiedEdge verdict_by(const std::vector<double>& worths, const Edge& doubt) {
  const std::vector<EdgeCandidate>& candidates = doubt.candidates;
  std::vector<std::size_t> order(worths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t j, std::size_t k) { return worths[j] > worths[k]; });
  const EdgeCandidate& best = candidates[order.front()];
  double right = 0.0;
  double all = std::exp(worth_of_none(doubt) - worths[order.front()]);
  std::vector<Pose2> places;
  for (const std::size_t k : order) {
    const Pose2& pose = candidates[k].a_from_b;
    if (std::any_of(places.begin(), places.end(), [&](const Pose2& place) { return is_same(place, pose); })) continue;
    places.push_back(pose);
    const double odds = std::exp(worths[k] - worths[order.front()]);
    all += odds;
    right += share_right(best, pose) * odds;
  }
  // The map has matched its own candidate to more scans than these two.
  const std::size_t taken = is_same(best.a_from_b, candidates[0].a_from_b) ? 0 : order.front();
  return {taken, right / all, false, {}, {}};
}

class Revision {
 public:
  Revision(const NodeViews& views, const std::vector<Edge>& doubtful, Submaps submaps,
           const VisibilityOptions& visibility, int threads)
      : views_(views),
        doubtful_(doubtful),
        submaps_(std::move(submaps)),
        visibility_(visibility),
        threads_(threads),
        edges_(doubtful.size()),
        is_stale_(doubtful.size(), 1) {}

  VerifiedMap run(double least_probability, RunObserver& observer) {
    while (observer.keep_going()) {
      const std::optional<std::size_t> next = most_probable(least_probability);
      if (!next) break;
      join(*next);
    }
    if (!observer.keep_going()) leave_as_they_were();
    return {submaps_.map_from_node(), submaps_.submap_of_node(), edges_};
  }

 private:
  std::optional<std::size_t> most_probable(double least_probability) {
    std::optional<std::size_t> best;
    for (std::size_t d = 0; d < doubtful_.size(); ++d) {
      if (submaps_.is_joined(doubtful_[d].a)) continue;
      if (is_stale_[d]) edges_[d] = judged(d);
      is_stale_[d] = 0;
      if (edges_[d].probability < least_probability) continue;
      if (!best || edges_[d].probability > edges_[*best].probability) best = d;
    }
    return best;
  }

  VerifiedEdge judged(std::size_t d) const {
    const Edge& doubt = doubtful_[d];
    std::vector<EdgeSupport> balances(doubt.candidates.size());
    parallel_for(balances.size(), threads_,
                 [&](std::size_t k) { balances[k] = support_by_others(doubt.a, doubt.candidates[k].a_from_b); });
    std::vector<double> parallel_support = said_by_parallel(d);
    const VerificationWeights& weights = kInference.verification_weights;
    std::vector<double> worths;
    for (std::size_t k = 0; k < balances.size(); ++k) {
      worths.push_back(worth_by_itself(doubt, k) + weights.by_others * balances[k].value() +
                       weights.by_parallel * parallel_support[k]);
    }
    VerifiedEdge verdict = verdict_by(worths, doubt);
    verdict.support_by_others = std::move(balances);
    verdict.parallel_support = std::move(parallel_support);
    return verdict;
  }

  /// Returns the balance of all pairs of scans of the two submaps that an edge joins, except for its own pair.
  EdgeSupport support_by_others(std::size_t edge, const Pose2& a_from_b) const {
    const std::vector<Pose2>& poses = submaps_.map_from_node();
    const std::vector<std::size_t>& submap = submaps_.submap_of_node();
    const Pose2 move = submaps_.moved_by(edge, a_from_b);
    const auto [within_m, window] = std::pair(kInference.verification.within_m, kInference.verification.window);
    const std::size_t first = edge + 1 - std::min(window, edge + 1);
    const std::size_t last = std::min(poses.size(), edge + 1 + window);
    EdgeSupport balance;
    for (std::size_t a = first; a < last; ++a) {
      if (submap[a] != submap[edge]) continue;
      for (std::size_t b = first; b < last; ++b) {
        if (submap[b] != submap[edge + 1] || (a == edge && b == edge + 1)) continue;
        const Pose2 near_from_far = inverse(poses[a]) * (move * poses[b]);
        if (near_from_far.translation().norm() > within_m) continue;
        balance.add(MapScore::of_pair(shapemap::visibility(*views_[a], *views_[b], near_from_far, visibility_,
                                                           {kInference.agreement.odometry_slack, 1})));
      }
    }
    return balance;
  }

  /// Returns, for each candidate, how much more the most convincing parallel edge says for it than for none of its own
  /// candidates. The two edges are not independent, so it counts in part.
  std::vector<double> said_by_parallel(std::size_t d) const {
    const Edge& doubt = doubtful_[d];
    std::vector<double> said(doubt.candidates.size(), 0.0);
    for (const std::size_t e : parallel_to(d)) {
      if (!are_near(d, e)) continue;
      const Edge& other = doubtful_[e];
      for (std::size_t j = 0; j < other.candidates.size(); ++j) {
        const Pose2 place = submaps_.carried_to(doubt.a, other.a, other.candidates[j].a_from_b);
        const double more_than_none = worth_by_itself(other, j) - worth_of_none(other);
        for (std::size_t k = 0; k < said.size(); ++k) {
          if (is_same(place, doubt.candidates[k].a_from_b)) said[k] = std::max(said[k], more_than_none);
        }
      }
    }
    return said;
  }

  std::vector<std::size_t> parallel_to(std::size_t d) const {
    std::vector<std::size_t> parallel;
    for (std::size_t e = 0; e < doubtful_.size(); ++e) {
      if (e != d && submaps_.are_parallel(doubtful_[d].a, doubtful_[e].a)) parallel.push_back(e);
    }
    return parallel;
  }

  bool are_near(std::size_t d, std::size_t e) const {
    const auto [before, after] = std::minmax(doubtful_[d].a, doubtful_[e].a);
    return after - before <= kInference.verification.window;
  }

  /// Joins the edge and the parallel edges that agree with it. A parallel edge that contradicts it can only be right if
  /// this one is wrong.
  void join(std::size_t d) {
    const std::size_t edge = doubtful_[d].a;
    const Pose2 a_from_b = doubtful_[d].candidates[edges_[d].candidate].a_from_b;
    const double probability = edges_[d].probability;
    for (const std::size_t e : parallel_to(d)) {
      const Pose2 place = submaps_.carried_to(doubtful_[e].a, edge, a_from_b);
      const std::optional<std::size_t> same = candidate_at(place, doubtful_[e], are_near(d, e));
      edges_[e].joins = same.has_value();
      edges_[e].candidate = same.value_or(edges_[e].candidate);
      edges_[e].probability = same ? probability : std::min(edges_[e].probability, 1.0 - probability);
    }
    edges_[d].joins = true;
    submaps_.join(edge, a_from_b);
    const std::vector<std::size_t>& submap = submaps_.submap_of_node();
    for (std::size_t e = 0; e < doubtful_.size(); ++e) {
      const std::size_t other = doubtful_[e].a;
      if (submap[other] == submap[edge] || submap[other + 1] == submap[edge]) is_stale_[e] = 1;
    }
  }

  /// Returns the candidate at `place`: that of the map if it is there, else the nearest. More difference is allowed
  /// along a long trajectory.
  static std::optional<std::size_t> candidate_at(const Pose2& place, const Edge& doubt, bool is_near) {
    std::optional<std::size_t> nearest;
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < doubt.candidates.size(); ++k) {
      const Pose2& pose = doubt.candidates[k].a_from_b;
      const AgreementNumbers& numbers = kInference.agreement;
      if (!agrees(pose, place, is_near ? numbers.same_candidate : numbers.contradicts)) continue;
      if (k == 0) return k;
      const double off_m = (inverse(pose) * place).translation().norm();
      if (off_m >= nearest_m) continue;
      nearest = k;
      nearest_m = off_m;
    }
    return nearest;
  }

  void leave_as_they_were() {
    for (std::size_t d = 0; d < doubtful_.size(); ++d) {
      const std::size_t edge = doubtful_[d].a;
      const Pose2& in_map = doubtful_[d].candidates.front().a_from_b;
      if (edges_[d].joins || (submaps_.is_joined(edge) && !is_same(submaps_.step(edge), in_map))) continue;
      if (!submaps_.is_joined(edge)) submaps_.join(edge, in_map);
      edges_[d] = {0, 0.0, true, {}, {}};
    }
  }

  const NodeViews& views_;
  const std::vector<Edge>& doubtful_;
  Submaps submaps_;
  const VisibilityOptions& visibility_;
  int threads_;
  std::vector<VerifiedEdge> edges_;
  std::vector<char> is_stale_;
};

}  // namespace

VerifiedMap verify_edges(const NodeViews& views, SubmapPoses submaps, const std::vector<Edge>& doubtful,
                         const EdgeVerification& options, const Execution& execution) {
  Submaps joined(std::move(submaps.map_from_node), std::move(submaps.submap_of_node));
  return Revision(views, doubtful, std::move(joined), options.visibility, execution.threads)
      .run(options.least_probability, execution.observer);
}

}  // namespace shapemap
