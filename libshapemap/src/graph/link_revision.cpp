// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/link_revision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shapemap/core/parallel_for.hpp"
#include "shapemap/graph/loop_closing.hpp"
#include "shapemap/graph/map_evidence.hpp"

namespace shapemap {
namespace {

/// Scans farther apart see nothing in common, and scans farther along the chain lie less exactly.
constexpr double kWithin_m = 8.0;
constexpr std::size_t kWindow = 16;

/// Poses are as exact as a chain makes them.
constexpr double kSlack = 1.3;

/// However badly two scans go together by themselves, the others may know better.
constexpr double kLeastScore = -8.0;

/// Candidates nearer than this are the same, and no rivals.
constexpr double kSame_m = 0.40;
constexpr double kSame_rad = 8 * kDegree;

/// The right place may be none of the candidates: the best is then better than the others, and still bad. That it is
/// good makes it no more certain: of two that fit alike, each is right half of the time.
constexpr double kShareOfValue = 0.5;

/// Of rivals that are worse still, no more is made: the best of many bad ones may be far ahead.
constexpr double kFullLead = 10.0;

bool is_same(const Pose2& a, const Pose2& b) {
  return (a.translation() - b.translation()).norm() < kSame_m && angle_between(a.theta_rad, b.theta_rad) < kSame_rad;
}

struct Verdict {
  int best = kCut;
  double value = -std::numeric_limits<double>::infinity();
  double certainty = 0.0;
};

class Revision {
 public:
  Revision(const NodeViews& views, std::vector<Pose2> map_from_node, std::vector<std::size_t> piece_of_node,
           const VisibilityOptions& visibility, int threads)
      : views_(views),
        poses_(std::move(map_from_node)),
        piece_(std::move(piece_of_node)),
        visibility_(visibility),
        threads_(threads) {}

  Verdict judge(const DoubtfulLink& doubt) const {
    std::vector<double> values(doubt.candidates.size());
    parallel_for(values.size(), threads_, [&](std::size_t k) {
      const DoubtfulLink::Candidate& candidate = doubt.candidates[k];
      values[k] = std::max(kLeastScore, candidate.score) + evidence(doubt.link, candidate.a_from_b);
    });
    Verdict verdict;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (values[k] <= verdict.value) continue;
      verdict.best = static_cast<int>(k);
      verdict.value = values[k];
    }
    double second = verdict.value - kFullLead;
    const Pose2& best = doubt.candidates[static_cast<std::size_t>(verdict.best)].a_from_b;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!is_same(doubt.candidates[k].a_from_b, best)) second = std::max(second, values[k]);
    }
    verdict.certainty = verdict.value - second + std::min(0.0, kShareOfValue * verdict.value);
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

  /// Of all pairs of scans of the two pieces that a link joins.
  double evidence(std::size_t link, const Pose2& a_from_b) const {
    const Pose2 move = moved_by(link, a_from_b);
    const std::size_t first = link + 1 - std::min(kWindow, link + 1);
    const std::size_t last = std::min(poses_.size(), link + 1 + kWindow);
    double sum = 0.0;
    for (std::size_t a = first; a < last; ++a) {
      if (piece_[a] != piece_[link]) continue;
      for (std::size_t b = first; b < last; ++b) {
        if (piece_[b] != piece_[link + 1]) continue;
        const Pose2 near_from_far = inverse(poses_[a]) * (move * poses_[b]);
        if (near_from_far.translation().norm() > kWithin_m) continue;
        sum += MapEvidence::of_pair(shapemap::visibility(*views_[a], *views_[b], near_from_far, visibility_, kSlack));
      }
    }
    return sum;
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
                        const VisibilityOptions& visibility, double least_certainty, int threads,
                        RunObserver& observer) {
  Revision revision(views, std::move(map_from_node), std::move(piece_of_node), visibility, threads);
  RevisedMap result;
  result.choice.assign(doubtful.size(), kCut);
  result.certainty.assign(doubtful.size(), 0.0);
  std::vector<Verdict> verdicts(doubtful.size());
  std::vector<char> is_stale(doubtful.size(), 1);
  while (observer.keep_going()) {
    std::size_t next = doubtful.size();
    for (std::size_t d = 0; d < doubtful.size(); ++d) {
      if (result.choice[d] != kCut) continue;
      if (is_stale[d]) verdicts[d] = revision.judge(doubtful[d]);
      is_stale[d] = 0;
      if (verdicts[d].certainty < least_certainty) continue;
      if (next == doubtful.size() || verdicts[d].certainty > verdicts[next].certainty) next = d;
    }
    if (next == doubtful.size()) break;
    const std::size_t link = doubtful[next].link;
    result.choice[next] = verdicts[next].best;
    result.certainty[next] = verdicts[next].certainty;
    revision.join(link, doubtful[next].candidates[static_cast<std::size_t>(verdicts[next].best)].a_from_b);
    for (std::size_t d = 0; d < doubtful.size(); ++d) {
      const std::size_t joined = revision.piece_of(link);
      if (revision.piece_of(doubtful[d].link) == joined || revision.piece_of(doubtful[d].link + 1) == joined) {
        is_stale[d] = 1;
      }
    }
  }
  if (!observer.keep_going()) {
    for (std::size_t d = 0; d < doubtful.size(); ++d) {
      if (result.choice[d] != kCut) continue;
      result.choice[d] = 0;
      revision.join(doubtful[d].link, doubtful[d].candidates.front().a_from_b);
    }
  }
  std::move(revision).give(result);
  return result;
}

}  // namespace shapemap
