// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/link_revision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "map_pieces.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/graph/loop_closing.hpp"
#include "shapemap/graph/map_evidence.hpp"
#include "shapemap/graph/pose_graph.hpp"

namespace shapemap {
namespace {

/// Scans farther apart see nothing in common, and scans farther along the chain lie less exactly.
constexpr double kWithin_m = 8.0;
constexpr std::size_t kWindow = 16;

/// Poses are as exact as a chain makes them.
constexpr double kSlack = 1.3;

/// Candidates nearer than this are the same.
constexpr double kSame_m = 0.40;
constexpr double kSame_rad = 8 * kDegree;

/// What a candidate is worth, as logarithm of odds: a multinomial logit, fitted to doubtful links of thinned real logs
/// and of simulated arenas by scripts/evaluate.py fit-edges.
constexpr double kPerScore = 0.63;
constexpr double kLeastScore = -12.0;  ///< however badly two scans go together by themselves, others may know better
constexpr double kByOthers = 2.9;
constexpr double kOfMap = 1.2;     ///< the whole map was asked already
constexpr double kPerLoose = 0.5;  ///< a place that the two scans hold in no direction stands for many
constexpr double kByParallel = 0.5;
constexpr double kNoneOfThem = -5.7;
constexpr double kPerShortfall = 25.0;  ///< the less two scans see, the likelier; fitted to hard scenes

/// By its two scans, and whether the map has it.
double worth_by_itself(const DoubtfulLink& doubt, std::size_t k) {
  const DoubtfulLink::Candidate& candidate = doubt.candidates[k];
  return kPerScore * std::max(kLeastScore, candidate.score) - kPerLoose * std::log1p(candidate.best_deviation_m) +
         (k == 0 ? kOfMap : 0.0);
}

double worth_of_none(const DoubtfulLink& doubt) { return kNoneOfThem + kPerShortfall * doubt.view_shortfall; }

bool is_same(const Pose2& a, const Pose2& b) {
  return (a.translation() - b.translation()).norm() < kSame_m && angle_between(a.theta_rad, b.theta_rad) < kSame_rad;
}

/// How right it is to be at the candidate `one` when `other` is true: a place is right or not, but along a corridor it
/// slides, and is the less right the farther.
double share_right(const DoubtfulLink::Candidate& one, const Pose2& other) {
  if (is_same(one.a_from_b, other)) return 1.0;
  return std::max(0.0, 1.0 - deviations_off({0, 0, one.a_from_b, one.covariance, 0.0}, other) / kSameDeviations);
}

/// The best candidate by their `worths`, against all others, and none of them. Where nothing holds it along a corridor,
/// it is right if any is that it may slide to.
RevisedLink verdict_by(const std::vector<double>& worths, const DoubtfulLink& doubt) {
  const std::vector<DoubtfulLink::Candidate>& candidates = doubt.candidates;
  std::vector<std::size_t> order(worths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t j, std::size_t k) { return worths[j] > worths[k]; });
  const DoubtfulLink::Candidate& best = candidates[order.front()];
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
  // The map has aligned its own to more than these two.
  const std::size_t taken = is_same(best.a_from_b, candidates[0].a_from_b) ? 0 : order.front();
  return {taken, right / all, false, {}, {}};
}

class Revision {
 public:
  Revision(const NodeViews& views, const std::vector<DoubtfulLink>& doubtful, MapPieces pieces,
           const VisibilityOptions& visibility, int threads)
      : views_(views),
        doubtful_(doubtful),
        pieces_(std::move(pieces)),
        visibility_(visibility),
        threads_(threads),
        links_(doubtful.size()),
        is_stale_(doubtful.size(), 1) {}

  RevisedMap run(double least_probability, RunObserver& observer) {
    while (observer.keep_going()) {
      const std::optional<std::size_t> next = most_probable(least_probability);
      if (!next) break;
      join(*next);
    }
    if (!observer.keep_going()) leave_as_they_were();
    return {pieces_.map_from_node(), pieces_.piece_of_node(), links_};
  }

 private:
  std::optional<std::size_t> most_probable(double least_probability) {
    std::optional<std::size_t> best;
    for (std::size_t d = 0; d < doubtful_.size(); ++d) {
      if (pieces_.is_joined(doubtful_[d].link)) continue;
      if (is_stale_[d]) links_[d] = judged(d);
      is_stale_[d] = 0;
      if (links_[d].probability < least_probability) continue;
      if (!best || links_[d].probability > links_[*best].probability) best = d;
    }
    return best;
  }

  RevisedLink judged(std::size_t d) const {
    const DoubtfulLink& doubt = doubtful_[d];
    std::vector<Balance> balances(doubt.candidates.size());
    parallel_for(balances.size(), threads_,
                 [&](std::size_t k) { balances[k] = said_by_others(doubt.link, doubt.candidates[k].a_from_b); });
    std::vector<double> vouched = said_by_parallel(d);
    std::vector<double> worths;
    for (std::size_t k = 0; k < balances.size(); ++k) {
      worths.push_back(worth_by_itself(doubt, k) + kByOthers * balances[k].value() + kByParallel * vouched[k]);
    }
    RevisedLink verdict = verdict_by(worths, doubt);
    verdict.said_by_others = std::move(balances);
    verdict.vouched = std::move(vouched);
    return verdict;
  }

  /// By all pairs of scans of the two pieces that a link joins, but for the two of the link.
  Balance said_by_others(std::size_t link, const Pose2& a_from_b) const {
    const std::vector<Pose2>& poses = pieces_.map_from_node();
    const std::vector<std::size_t>& piece = pieces_.piece_of_node();
    const Pose2 move = pieces_.moved_by(link, a_from_b);
    const std::size_t first = link + 1 - std::min(kWindow, link + 1);
    const std::size_t last = std::min(poses.size(), link + 1 + kWindow);
    Balance balance;
    for (std::size_t a = first; a < last; ++a) {
      if (piece[a] != piece[link]) continue;
      for (std::size_t b = first; b < last; ++b) {
        if (piece[b] != piece[link + 1] || (a == link && b == link + 1)) continue;
        const Pose2 near_from_far = inverse(poses[a]) * (move * poses[b]);
        if (near_from_far.translation().norm() > kWithin_m) continue;
        balance.add(
            MapEvidence::of_pair(shapemap::visibility(*views_[a], *views_[b], near_from_far, visibility_, kSlack)));
      }
    }
    return balance;
  }

  /// Of each candidate, how much more than none of its own the parallel link says for it that says most. The two do not
  /// tell independently of each other, so it counts in part.
  std::vector<double> said_by_parallel(std::size_t d) const {
    const DoubtfulLink& doubt = doubtful_[d];
    std::vector<double> said(doubt.candidates.size(), 0.0);
    for (const std::size_t e : parallel_to(d)) {
      if (!are_near(d, e)) continue;
      const DoubtfulLink& other = doubtful_[e];
      for (std::size_t j = 0; j < other.candidates.size(); ++j) {
        const Pose2 place = pieces_.carried_to(doubt.link, other.link, other.candidates[j].a_from_b);
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
      if (e != d && pieces_.are_parallel(doubtful_[d].link, doubtful_[e].link)) parallel.push_back(e);
    }
    return parallel;
  }

  bool are_near(std::size_t d, std::size_t e) const {
    const auto [before, after] = std::minmax(doubtful_[d].link, doubtful_[e].link);
    return after - before <= kWindow;
  }

  /// With the parallel links that say the same; those that say otherwise are no more probable than that it is wrong.
  void join(std::size_t d) {
    const std::size_t link = doubtful_[d].link;
    const Pose2 a_from_b = doubtful_[d].candidates[links_[d].candidate].a_from_b;
    const double probability = links_[d].probability;
    for (const std::size_t e : parallel_to(d)) {
      const Pose2 place = pieces_.carried_to(doubtful_[e].link, link, a_from_b);
      const std::optional<std::size_t> same = candidate_at(place, doubtful_[e], are_near(d, e));
      links_[e].joins = same.has_value();
      links_[e].candidate = same.value_or(links_[e].candidate);
      links_[e].probability = same ? probability : std::min(links_[e].probability, 1.0 - probability);
    }
    links_[d].joins = true;
    pieces_.join(link, a_from_b);
    const std::vector<std::size_t>& piece = pieces_.piece_of_node();
    for (std::size_t e = 0; e < doubtful_.size(); ++e) {
      const std::size_t other = doubtful_[e].link;
      if (piece[other] == piece[link] || piece[other + 1] == piece[link]) is_stale_[e] = 1;
    }
  }

  /// That of the map where it is one, else the nearest. Along a long way more must be allowed for.
  static std::optional<std::size_t> candidate_at(const Pose2& place, const DoubtfulLink& doubt, bool is_near) {
    std::optional<std::size_t> nearest;
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < doubt.candidates.size(); ++k) {
      const Pose2& pose = doubt.candidates[k].a_from_b;
      const Pose2 off = inverse(pose) * place;
      if (!(is_near ? is_same(place, pose) : is_within(off, kContradicts_m, kContradicts_rad))) continue;
      if (k == 0) return k;
      if (off.translation().norm() >= nearest_m) continue;
      nearest = k;
      nearest_m = off.translation().norm();
    }
    return nearest;
  }

  void leave_as_they_were() {
    for (std::size_t d = 0; d < doubtful_.size(); ++d) {
      const std::size_t link = doubtful_[d].link;
      const Pose2& in_map = doubtful_[d].candidates.front().a_from_b;
      if (links_[d].joins || (pieces_.is_joined(link) && !is_same(pieces_.step(link), in_map))) continue;
      if (!pieces_.is_joined(link)) pieces_.join(link, in_map);
      links_[d] = {0, 0.0, true, {}, {}};
    }
  }

  const NodeViews& views_;
  const std::vector<DoubtfulLink>& doubtful_;
  MapPieces pieces_;
  const VisibilityOptions& visibility_;
  int threads_;
  std::vector<RevisedLink> links_;
  std::vector<char> is_stale_;
};

}  // namespace

RevisedMap revise_links(const NodeViews& views, std::vector<Pose2> map_from_node,
                        std::vector<std::size_t> piece_of_node, const std::vector<DoubtfulLink>& doubtful,
                        const VisibilityOptions& visibility, double least_probability, int threads,
                        RunObserver& observer) {
  MapPieces pieces(std::move(map_from_node), std::move(piece_of_node));
  return Revision(views, doubtful, std::move(pieces), visibility, threads).run(least_probability, observer);
}

}  // namespace shapemap
