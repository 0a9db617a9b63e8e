// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/loop_closing.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "loop_choice.hpp"
#include "map_assembly.hpp"

namespace shapemap {
namespace {

/// A map that is farther than this off what a loop says contradicts it.
constexpr double kContradicts_m = 1.0;
constexpr double kContradicts_rad = 10 * kDegree;

constexpr double kStrong = 10.0;
constexpr double kVeryDoubtful = 0.65;

/// No more maps are assembled when so many in a row are not better by this share.
constexpr int kAssembliesInVain = 3;
constexpr double kLeastGain = 0.01;
constexpr int kRoundsOfClosing = 3;
constexpr int kRoundsOfRepair = 4;
constexpr std::size_t kDoubtfulPerLoop = 4;

/// What joins two pieces is all that tells of where they are to each other. It must be this strong, come from so many
/// nodes of each, and be so many times as strong as the next that would join them otherwise: places look alike.
constexpr double kJoiningStrength = 18.0;
constexpr std::size_t kJoiningNodes = 3;
constexpr double kJoiningLead = 2.0;

/// A change is not pursued when the map is so much worse before loops follow.
constexpr double kHopelessLink = 30.0;
constexpr double kHopelessLoop = 200.0;

bool within(const Pose2& off, double metres, double radians) {
  return off.translation().norm() < metres && std::abs(off.theta_rad) < radians;
}

class LoopCloser {
 public:
  LoopCloser(LoopProblem& problem, const std::vector<ChainLink>& links, const std::vector<LoopCluster>& clusters,
             const LoopClosingOptions& options, RunObserver& observer)
      : problem_(problem), links_(links), clusters_(clusters), options_(options), observer_(observer) {}

  LoopChoice run(const std::vector<LoopHypothesis>& hypotheses) {
    LoopChoice chain = problem_.chain_alone();
    LoopChoice best = assembled(hypotheses, chain.map_from_node);
    close(best);
    close(chain);
    if (chain.value > best.value) best = std::move(chain);
    repair(best);
    return best;
  }

 private:
  /// The best of some maps that are assembled of pieces; no more are tried when several in a row are no better.
  LoopChoice assembled(const std::vector<LoopHypothesis>& hypotheses, const std::vector<Pose2>& map_of_chain) {
    LoopChoice best;
    int in_vain = 0;
    for (int variant = 0; variant < options_.assemblies && in_vain < kAssembliesInVain; ++variant) {
      if (variant > 0 && !observer_.keep_going()) break;
      LoopChoice trial =
          problem_.of_map(assembled_map(links_, hypotheses, map_of_chain, problem_.evidence(), variant, observer_));
      const bool is_better =
          variant == 0 || trial.value > best.value + std::max(options_.least_gain, kLeastGain * std::abs(best.value));
      in_vain = is_better ? 0 : in_vain + 1;
      if (is_better) best = std::move(trial);
    }
    return best;
  }

  /// Closes the loops that the map agrees with as it is.
  bool close_agreeing(LoopChoice& map) {
    LoopChoice trial = map;
    bool any = false;
    for (std::size_t k = 0; k < clusters_.size(); ++k) {
      if (trial.accepted[k] || clusters_[k].strength < kLeastStrength) continue;
      if (!within(problem_.off(trial, k), kAgrees_m, kAgrees_rad)) continue;
      trial.accepted[k] = 1;
      any = true;
    }
    if (!any) return false;
    problem_.solve(trial);
    problem_.rate(trial);
    if (trial.value < map.value) return false;
    map = std::move(trial);
    return true;
  }

  std::vector<std::size_t> pieces(const LoopChoice& map) const {
    return connected_parts(problem_.num_nodes(), problem_.constraints(map));
  }

  /// Whether loop `k` may decide where two pieces are to each other.
  bool can_join(const LoopChoice& map, const std::vector<std::size_t>& piece, std::size_t k) const {
    const LoopCluster& cluster = clusters_[k];
    if (cluster.strength < kJoiningStrength || std::min(cluster.num_a, cluster.num_b) < kJoiningNodes) return false;
    const PoseConstraint& loop = problem_.best_member(k);
    const Pose2 move = join(map, loop);
    for (std::size_t other = 0; other < clusters_.size(); ++other) {
      if (clusters_[other].strength * kJoiningLead < cluster.strength) continue;
      const PoseConstraint& rival = problem_.best_member(other);
      const bool same_pieces = piece[rival.a] == piece[loop.a] && piece[rival.b] == piece[loop.b];
      if (!same_pieces) continue;
      const Pose2 predicted = inverse(map.map_from_node[rival.a]) * move * map.map_from_node[rival.b];
      if (!within(inverse(rival.a_from_b) * predicted, kContradicts_m, kContradicts_rad)) return false;
    }
    return true;
  }

  /// How the piece of the later node moves to where a loop wants it.
  static Pose2 join(const LoopChoice& map, const PoseConstraint& loop) {
    return map.map_from_node[loop.a] * loop.a_from_b * inverse(map.map_from_node[loop.b]);
  }

  /// Brings two pieces that nothing joins yet to where a loop wants them; false if it may not decide that.
  bool join_pieces(LoopChoice& map, std::size_t k) const {
    const PoseConstraint& loop = problem_.best_member(k);
    const std::vector<std::size_t> piece = pieces(map);
    if (piece[loop.a] == piece[loop.b]) return true;
    if (!can_join(map, piece, k)) return false;
    const Pose2 move = join(map, loop);
    for (std::size_t n = 0; n < problem_.num_nodes(); ++n) {
      if (piece[n] == piece[loop.b]) map.map_from_node[n] = move * map.map_from_node[n];
    }
    return true;
  }

  bool try_loop(LoopChoice& map, std::size_t k) {
    LoopChoice trial = map;
    if (!join_pieces(trial, k)) return false;
    trial.accepted[k] = 1;
    problem_.solve(trial);
    const double without_scans = problem_.worth(k) - 0.5 * (trial.chi_square - map.chi_square);
    if (without_scans < -options_.trust_cap) return false;
    problem_.rate(trial);
    if (trial.value < map.value + options_.least_gain) return false;
    map = std::move(trial);
    return true;
  }

  /// Closes all loops that gain, strongest first.
  void close(LoopChoice& map) {
    bool again = true;
    for (int round = 0; again && round < kRoundsOfClosing; ++round) {
      again = false;
      close_all_agreeing(map);
      for (std::size_t k = 0; k < clusters_.size() && observer_.keep_going(); ++k) {
        if (map.accepted[k] || clusters_[k].strength < kLeastStrength) continue;
        const Pose2 off = problem_.off(map, k);
        if (within(inverse(map.refused_off[k]) * off, kAgrees_m, kAgrees_rad)) continue;
        if (try_loop(map, k)) {
          again = true;
          close_all_agreeing(map);
        } else {
          map.refused_off[k] = off;
        }
      }
    }
  }

  void close_all_agreeing(LoopChoice& map) {
    while (observer_.keep_going() && close_agreeing(map)) {
    }
  }

  /// Moves what the chain has after link `i`; loops that then are contradicted are given up.
  void swing(LoopChoice& map, std::size_t i, const Pose2& move) const {
    std::size_t n = i + 1;
    do {
      map.map_from_node[n] = move * map.map_from_node[n];
      ++n;
    } while (n < problem_.num_nodes() && map.link_choice[n - 1] != kCut);
    for (std::size_t k = 0; k < clusters_.size(); ++k) {
      if (map.accepted[k] && !within(problem_.off(map, k), kContradicts_m, kContradicts_rad)) map.accepted[k] = 0;
    }
  }

  /// Closes the loops of a changed map, and takes it if it then is better.
  bool better_when_closed(LoopChoice& trial, LoopChoice& best, double hopeless) {
    problem_.solve(trial);
    problem_.rate(trial);
    close_all_agreeing(trial);
    if (trial.value < best.value - hopeless) return false;
    close(trial);
    if (trial.value < best.value + options_.least_gain) return false;
    best = std::move(trial);
    tried_.clear();
    return true;
  }

  /// Whether a change of the best map so far has not been tried yet; what was tried is not worth another look until the
  /// map changes.
  bool is_new(std::size_t link, int choice, std::size_t loop) { return tried_.insert({link, choice, loop}).second; }

  bool try_alternatives(LoopChoice& best, std::size_t i) {
    const auto count = static_cast<int>(links_[i].alternatives.size());
    for (int choice = 0; choice < count && observer_.keep_going(); ++choice) {
      if (choice == best.link_choice[i] || !is_new(i, choice, clusters_.size())) continue;
      LoopChoice trial = best;
      trial.link_choice[i] = choice;
      const Pose2& a_from_b = links_[i].alternatives[static_cast<std::size_t>(choice)].a_from_b;
      swing(trial, i, trial.map_from_node[i] * a_from_b * inverse(trial.map_from_node[i + 1]));
      const bool was_changed = best.link_choice[i] != 0;
      if (better_when_closed(trial, best, was_changed ? kHopelessLoop : kHopelessLink)) return true;
    }
    return false;
  }

  /// A strong loop that does not fit: one of the alignments along it may be wrong.
  bool try_cutting_for(LoopChoice& best, std::size_t k) {
    const PoseConstraint& loop = problem_.best_member(k);
    const std::vector<std::size_t> piece = pieces(best);
    if (piece[loop.a] != piece[loop.b]) return false;
    const std::vector<std::size_t> doubtful = doubtful_links(loop.a, loop.b, kDoubtfulPerLoop);
    for (const std::size_t i : doubtful) {
      if (best.link_choice[i] == kCut || !observer_.keep_going() || !is_new(i, kCut, k)) continue;
      LoopChoice trial = best;
      trial.link_choice[i] = kCut;
      swing(trial, i, trial.map_from_node[loop.a] * loop.a_from_b * inverse(trial.map_from_node[loop.b]));
      trial.accepted[k] = 1;
      if (better_when_closed(trial, best, kHopelessLoop)) return true;
    }
    return false;
  }

  /// The least probable of the links from node `first` to node `last`.
  std::vector<std::size_t> doubtful_links(std::size_t first, std::size_t last, std::size_t count) const {
    std::vector<std::size_t> doubtful;
    for (std::size_t i = first; i < last; ++i) {
      if (links_[i].exists() && links_[i].probability < doubt_below_) doubtful.push_back(i);
    }
    std::stable_sort(doubtful.begin(), doubtful.end(),
                     [&](std::size_t i, std::size_t j) { return links_[i].probability < links_[j].probability; });
    doubtful.resize(std::min(doubtful.size(), count));
    return doubtful;
  }

  /// Those that do not take what the chain took.
  std::vector<std::size_t> changed_links(const LoopChoice& map) const {
    std::vector<std::size_t> changed;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      if (links_[i].exists() && map.link_choice[i] != 0) changed.push_back(i);
    }
    return changed;
  }

  /// The most doubtful links come first: a wrong loop that needs a better link cut must not get in their way.
  void repair(LoopChoice& best) {
    for (const double doubt_below : {kVeryDoubtful * options_.doubt_below, options_.doubt_below}) {
      doubt_below_ = doubt_below;
      repair_doubtful(best);
    }
  }

  void repair_doubtful(LoopChoice& best) {
    bool better = true;
    for (int round = 0; better && round < kRoundsOfRepair; ++round) {
      better = false;
      int left = options_.repairs;
      for (std::size_t k = 0; k < clusters_.size() && left > 0; ++k) {
        if (best.accepted[k] || clusters_[k].strength < kStrong) continue;
        --left;
        better = try_cutting_for(best, k) || better;
      }
      for (const std::size_t i : changed_links(best)) better = try_alternatives(best, i) || better;
      for (const std::size_t i : doubtful_links(0, links_.size(), static_cast<std::size_t>(options_.repairs))) {
        if (best.link_choice[i] == 0) better = try_alternatives(best, i) || better;
      }
    }
  }

  LoopProblem& problem_;
  const std::vector<ChainLink>& links_;
  const std::vector<LoopCluster>& clusters_;
  const LoopClosingOptions& options_;
  RunObserver& observer_;
  double doubt_below_ = 0.0;                                   ///< links that are less probable may be changed
  std::set<std::tuple<std::size_t, int, std::size_t>> tried_;  ///< with the best map so far
};

}  // namespace

LoopSolution close_loops(const std::vector<std::shared_ptr<const ScanView>>& views, const std::vector<ChainLink>& links,
                         const std::vector<LoopHypothesis>& hypotheses, const std::vector<LoopCluster>& clusters,
                         const VisibilityOptions& visibility, const LoopClosingOptions& options, int threads,
                         RunObserver& observer) {
  LoopProblem problem(views, links, clusters, visibility, options, threads);
  LoopChoice best = LoopCloser(problem, links, clusters, options, observer).run(hypotheses);
  LoopSolution solution;
  solution.component = connected_parts(views.size(), problem.constraints(best));
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    if (best.accepted[k]) solution.accepted.push_back(k);
  }
  solution.map_from_node = std::move(best.map_from_node);
  solution.link_choice = std::move(best.link_choice);
  solution.value = best.value;
  return solution;
}

}  // namespace shapemap
