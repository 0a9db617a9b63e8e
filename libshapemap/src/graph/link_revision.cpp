// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/link_revision.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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
/// and of simulated arenas by scripts/fit_links.py.
constexpr double kPerScore = 0.63;
constexpr double kLeastScore = -12.0;  ///< however badly two scans go together by themselves, others may know better
constexpr double kByOthers = 2.9;
constexpr double kOfMap = 1.2;  ///< the whole map was asked already
constexpr double kNoneOfThem = -5.6;
constexpr double kPerShortfall = 25.0;  ///< the less two scans see, the likelier; fitted to hard scenes

double worth(const DoubtfulLink& doubt, std::size_t k, const Balance& said_by_others) {
  return kPerScore * std::max(kLeastScore, doubt.candidates[k].score) + kByOthers * said_by_others.value() +
         (k == 0 ? kOfMap : 0.0);
}

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
  double all = std::exp(kNoneOfThem + kPerShortfall * doubt.view_shortfall - worths[order.front()]);
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
  return {taken, right / all, false, {}};
}

class Revision {
 public:
  Revision(const NodeViews& views, std::vector<Pose2> map_from_node, std::vector<std::size_t> piece_of_node,
           const VisibilityOptions& visibility, int threads)
      : views_(views),
        poses_(std::move(map_from_node)),
        piece_(std::move(piece_of_node)),
        visibility_(visibility),
        threads_(threads) {}

  RevisedLink judge(const DoubtfulLink& doubt) const {
    std::vector<Balance> balances(doubt.candidates.size());
    parallel_for(balances.size(), threads_,
                 [&](std::size_t k) { balances[k] = said_by_others(doubt.link, doubt.candidates[k].a_from_b); });
    std::vector<double> worths;
    for (std::size_t k = 0; k < balances.size(); ++k) worths.push_back(worth(doubt, k, balances[k]));
    RevisedLink verdict = verdict_by(worths, doubt);
    verdict.said_by_others = std::move(balances);
    return verdict;
  }

  void join(std::size_t link, const Pose2& a_from_b) {
    const Pose2 move = moved_by(link, a_from_b);
    const std::size_t from = piece_[link + 1];
    for (std::size_t n = 0; n < poses_.size(); ++n) {
      if (piece_[n] != from) continue;
      poses_[n] = move * poses_[n];
      piece_[n] = piece_[link];
    }
  }

  std::size_t piece_of(std::size_t node) const { return piece_[node]; }
  void give(RevisedMap& result) && {
    result.map_from_node = std::move(poses_);
    result.piece_of_node = std::move(piece_);
  }

 private:
  /// How the piece of the later node moves.
  Pose2 moved_by(std::size_t link, const Pose2& a_from_b) const {
    return poses_[link] * a_from_b * inverse(poses_[link + 1]);
  }

  /// By all pairs of scans of the two pieces that a link joins, but for the two of the link.
  Balance said_by_others(std::size_t link, const Pose2& a_from_b) const {
    const Pose2 move = moved_by(link, a_from_b);
    const std::size_t first = link + 1 - std::min(kWindow, link + 1);
    const std::size_t last = std::min(poses_.size(), link + 1 + kWindow);
    Balance balance;
    for (std::size_t a = first; a < last; ++a) {
      if (piece_[a] != piece_[link]) continue;
      for (std::size_t b = first; b < last; ++b) {
        if (piece_[b] != piece_[link + 1] || (a == link && b == link + 1)) continue;
        const Pose2 near_from_far = inverse(poses_[a]) * (move * poses_[b]);
        if (near_from_far.translation().norm() > kWithin_m) continue;
        balance.add(
            MapEvidence::of_pair(shapemap::visibility(*views_[a], *views_[b], near_from_far, visibility_, kSlack)));
      }
    }
    return balance;
  }

  const NodeViews& views_;
  std::vector<Pose2> poses_;
  std::vector<std::size_t> piece_;
  const VisibilityOptions& visibility_;
  int threads_;
};

}  // namespace

RevisedMap revise_links(const NodeViews& views, std::vector<Pose2> map_from_node,
                        std::vector<std::size_t> piece_of_node, const std::vector<DoubtfulLink>& doubtful,
                        const VisibilityOptions& visibility, double least_probability, int threads,
                        RunObserver& observer) {
  Revision revision(views, std::move(map_from_node), std::move(piece_of_node), visibility, threads);
  RevisedMap result;
  std::vector<RevisedLink>& links = result.links;
  links.resize(doubtful.size());
  std::vector<char> is_stale(doubtful.size(), 1);
  while (observer.keep_going()) {
    std::size_t next = doubtful.size();
    for (std::size_t d = 0; d < doubtful.size(); ++d) {
      if (links[d].joins) continue;
      if (is_stale[d]) links[d] = revision.judge(doubtful[d]);
      is_stale[d] = 0;
      if (links[d].probability < least_probability) continue;
      if (next == doubtful.size() || links[d].probability > links[next].probability) next = d;
    }
    if (next == doubtful.size()) break;
    const std::size_t link = doubtful[next].link;
    links[next].joins = true;
    revision.join(link, doubtful[next].candidates[links[next].candidate].a_from_b);
    for (std::size_t d = 0; d < doubtful.size(); ++d) {
      const std::size_t joined = revision.piece_of(link);
      if (revision.piece_of(doubtful[d].link) == joined || revision.piece_of(doubtful[d].link + 1) == joined) {
        is_stale[d] = 1;
      }
    }
  }
  if (!observer.keep_going()) {
    for (std::size_t d = 0; d < doubtful.size(); ++d) {
      if (links[d].joins) continue;
      links[d] = {0, 0.0, true, {}};
      revision.join(doubtful[d].link, doubtful[d].candidates.front().a_from_b);
    }
  }
  std::move(revision).give(result);
  return result;
}

}  // namespace shapemap
