// SPDX-License-Identifier: GPL-3.0-or-later
#include "submap_merging.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "inference_numbers.hpp"
#include "loops/loops_numbers.hpp"
#include "motion/step_statistics.hpp"
#include "shapemap/graph/pose_graph.hpp"
#include "shapemap/matching/match_probability.hpp"
#include "submap_alignments.hpp"

namespace shapemap {
namespace {

using SubmapPair = std::pair<std::size_t, std::size_t>;

/// The best relative pose of two submaps, and its gain over the next best, or over leaving them apart.
struct Lead {
  SubmapAlignment best;
  double lead = 0.0;
  bool is_stale = false;  ///< whether one of the submaps has grown since
};

double log_odds(double probability) {
  const double p = std::clamp(probability, 1e-6, 1.0 - 1e-6);
  return log_odds_of(p);
}

class Assembly {
 public:
  Assembly(const std::vector<Edge>& edges, std::vector<Pose2> map_of_odometry, MapScore& score,
           const MapSearchOptions& options)
      : edges_(edges),
        options_(options),
        chain_(map_of_odometry),
        pose_(std::move(map_of_odometry)),
        score_(score),
        usual_step_m_(step_statistics(sure_steps(edges)).step_m),
        submap_(pose_.size(), 0),
        log_(pose_.size(), 0) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      submap_[i + 1] = submap_[i] + (is_sure(i) ? 0 : 1);
      log_[i + 1] = log_[i] + (edges[i].exists() ? 0 : 1);
    }
    nodes_.resize(submap_.back() + 1);
    within_.resize(nodes_.size());
    for (std::size_t n = 0; n < submap_.size(); ++n) nodes_[submap_[n]].push_back(n);
  }

  void add_joints(const std::vector<EdgeCandidate>& loops) {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const std::vector<EdgeCandidate>& candidates = edges_[i].candidates;
      for (const EdgeCandidate& way : candidates) {
        const double behind = std::min(0.0, way.score - candidates.front().score);
        add_joint(way, log_odds(edges_[i].probability * std::exp(behind)));
      }
    }
    for (const EdgeCandidate& loop : loops) {
      add_joint(loop, loop.score);
    }
  }

  void disturb(int variant) {
    if (variant == 0) return;
    std::mt19937_64 random(static_cast<std::uint64_t>(variant));
    for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
      const double share = std::ldexp(static_cast<double>(random() >> 11U), -53);
      noise_.push_back(kInference.merging.noise * (2.0 * share - 1.0));
    }
  }

  std::vector<Pose2> run(RunObserver& observer) {
    for (const auto& entry : between_) leads_[entry.first] = lead_of(entry.first);
    while (observer.keep_going() && !leads_.empty()) {
      const auto next = std::max_element(leads_.begin(), leads_.end(), [](const auto& one, const auto& other) {
        return one.second.lead < other.second.lead;
      });
      if (next->second.is_stale) {
        next->second = lead_of(next->first);
        continue;
      }
      if (next->second.lead < 0.0) break;
      const SubmapPair pair = next->first;
      const SubmapAlignment way = std::move(next->second.best);
      lay_together(pair, way);
    }
    join_the_rest();
    return std::move(pose_);
  }

 private:
  bool is_sure(std::size_t edge) const {
    return edges_[edge].exists() && edges_[edge].probability >= options_.doubt_below;
  }

  void add_joint(EdgeCandidate joint, double odds) {
    if (log_[joint.a] != log_[joint.b]) return;
    const std::size_t f = submap_[joint.a];
    const std::size_t g = submap_[joint.b];
    (f == g ? within_[f] : between_[{std::min(f, g), std::max(f, g)}]).push_back(joints_.size());
    joint.score = worth_among_others(odds);
    joints_.push_back(joint);
  }

  double cost_of_steps(const SubmapPair& pair, const Pose2& f_from_g) const {
    const MergingNumbers& numbers = kInference.merging;
    double cost = 0.0;
    std::size_t least = submap_.size();
    for (const Crossing& crossing : crossings(nodes_[pair.first], nodes_[pair.second])) {
      const double metres =
          (pose_[crossing.in_f].translation() - (f_from_g * pose_[crossing.in_g]).translation()).norm();
      const auto steps = static_cast<double>(crossing.num_steps);
      const double longer = std::clamp(metres / (usual_step_m_ * steps) - 1.0, 0.0, numbers.most_longer);
      cost += options_.step_penalty * longer * std::sqrt(steps);
      least = std::min(least, crossing.num_steps);
    }
    if (least > 1) {
      cost += numbers.revisit_penalty + numbers.revisit_penalty_per_log_step * std::log(static_cast<double>(least));
    }
    return cost;
  }

  Lead lead_of(const SubmapPair& pair) {
    std::vector<SubmapAlignment> ways =
        SubmapAlignments({joints_, pose_, submap_}, options_.trust_cap).ways(pair.first, between_[pair], noise_);
    const auto better = [](const SubmapAlignment& one, const SubmapAlignment& other) { return one.gain > other.gain; };
    for (SubmapAlignment& way : ways) way.gain -= cost_of_steps(pair, way.f_from_g);
    std::stable_sort(ways.begin(), ways.end(), better);
    ways.resize(std::min(ways.size(), kInference.merging.ways_tried));
    for (SubmapAlignment& way : ways) {
      way.gain += kInference.map_score_weights.weight *
                  score_.between(pose_, nodes_[pair.first], nodes_[pair.second], way.f_from_g);
    }
    std::stable_sort(ways.begin(), ways.end(), better);
    const double second = ways.size() > 1 ? std::max(0.0, ways[1].gain) : 0.0;
    return {ways[0], ways[0].gain - second};
  }

  /// Says whether all candidates of a relative pose are of one pair of scans.
  bool is_hinge(const SubmapAlignment& way) const {
    const EdgeCandidate& first = joints_[way.joints.front()];
    return std::all_of(way.joints.begin(), way.joints.end(),
                       [&](std::size_t joint) { return joints_[joint].a == first.a && joints_[joint].b == first.b; });
  }

  void lay_together(const SubmapPair& pair, const SubmapAlignment& way) {
    const auto [f, g] = pair;
    for (const std::size_t n : nodes_[g]) {
      pose_[n] = way.f_from_g * pose_[n];
      submap_[n] = f;
    }
    const bool f_is_smaller = nodes_[f].size() < nodes_[g].size();
    std::vector<std::size_t> all;
    std::merge(nodes_[f].begin(), nodes_[f].end(), nodes_[g].begin(), nodes_[g].end(), std::back_inserter(all));
    nodes_[f] = std::move(all);
    nodes_[g].clear();
    for (const std::vector<std::size_t>* more : {&within_[g], &between_[pair]}) {
      within_[f].insert(within_[f].end(), more->begin(), more->end());
    }
    between_.erase(pair);
    leads_.erase(pair);
    if (!is_hinge(way)) solve(f, way.joints);  // a single pair of scans bends no submap
    for (const SubmapPair& other : inherit(f, g, f_is_smaller)) leads_[other] = lead_of(other);
  }

  /// Gives the candidates between `g` and other submaps to `f`. Returns the pairs whose lead must be computed at once:
  /// those that got new candidates, and those of the smaller of the two submaps. The others have learned too little,
  /// and are computed again when it is their turn.
  std::vector<SubmapPair> inherit(std::size_t f, std::size_t g, bool f_is_smaller) {
    std::vector<SubmapPair> changed;
    std::vector<SubmapPair> gone;
    for (const auto& entry : between_) {
      const auto [one, other] = entry.first;
      if (one == g || other == g) gone.push_back(entry.first);
      if (one != f && other != f) continue;
      if (f_is_smaller) {
        changed.push_back(entry.first);
      } else {
        leads_[entry.first].is_stale = true;
      }
    }
    for (const SubmapPair& old : gone) {
      const std::size_t third = old.first == g ? old.second : old.first;
      const SubmapPair now{std::min(f, third), std::max(f, third)};
      const std::vector<std::size_t> joints = std::move(between_[old]);
      between_.erase(old);
      leads_.erase(old);
      between_[now].insert(between_[now].end(), joints.begin(), joints.end());
      changed.push_back(now);
    }
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    return changed;
  }

  /// Solves for a submap by its sure edges, the candidates `taken`, and all other candidates that agree with it.
  void solve(std::size_t f, const std::vector<std::size_t>& taken) {
    const std::vector<std::size_t>& nodes = nodes_[f];
    const auto number = [&](std::size_t n) {
      return static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), n) - nodes.begin());
    };
    std::vector<PoseConstraint> constraints;
    const auto add = [&](PoseConstraint constraint) {
      constraint.a = number(constraint.a);
      constraint.b = number(constraint.b);
      constraints.push_back(constraint);
    };
    std::vector<Pose2> poses;
    for (const std::size_t n : nodes) {
      poses.push_back(pose_[n]);
      if (n >= edges_.size() || !is_sure(n)) continue;
      const EdgeCandidate& edge = edges_[n].candidates.front();
      add({n, n + 1, edge.a_from_b, edge.covariance, 0.0});
    }
    const SubmapAlignments submaps({joints_, pose_, submap_}, options_.trust_cap);
    const std::set<std::size_t> decided(taken.begin(), taken.end());
    for (const std::size_t joint : within_[f]) {
      if (decided.count(joint) != 0 || submaps.holds(joints_[joint])) {
        const EdgeCandidate& c = joints_[joint];
        add({c.a, c.b, c.a_from_b, c.covariance, kInference.agreement.match_loss});
      }
    }
    const std::vector<Pose2> solved = solve_pose_graph(poses, constraints, kInference.merging.iterations).map_from_node;
    for (std::size_t k = 0; k < nodes.size(); ++k) pose_[nodes[k]] = solved[k];
  }

  void join_the_rest() {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const std::size_t f = submap_[i];
      const std::size_t g = submap_[i + 1];
      if (f == g) continue;
      const Pose2 move = pose_[i] * inverse(chain_[i]) * chain_[i + 1] * inverse(pose_[i + 1]);
      for (const std::size_t n : nodes_[g]) {
        pose_[n] = move * pose_[n];
        submap_[n] = f;
      }
      nodes_[f].insert(nodes_[f].end(), nodes_[g].begin(), nodes_[g].end());
      nodes_[g].clear();
    }
  }

  const std::vector<Edge>& edges_;
  const MapSearchOptions& options_;
  std::vector<Pose2> chain_;
  std::vector<Pose2> pose_;  ///< of each node, in the frame of its submap
  MapScore& score_;
  double usual_step_m_;
  std::vector<std::size_t> submap_;               ///< of each node
  std::vector<std::size_t> log_;                  ///< of each node: log, within which every edge exists
  std::vector<std::vector<std::size_t>> nodes_;   ///< of each submap, in order
  std::vector<EdgeCandidate> joints_;             ///< the score of each is its worth
  std::vector<double> noise_;                     ///< of each candidate, if any
  std::vector<std::vector<std::size_t>> within_;  ///< candidates within each submap
  std::map<SubmapPair, std::vector<std::size_t>> between_;
  std::map<SubmapPair, Lead> leads_;
};

}  // namespace

std::vector<Pose2> merged_submaps(const SubmapEvidence& evidence, MapScore& score, const MapSearchOptions& options,
                                  int variant, RunObserver& observer) {
  if (evidence.map_of_odometry.size() < 2) return evidence.map_of_odometry;
  Assembly assembly(evidence.edges, evidence.map_of_odometry, score, options);
  assembly.add_joints(evidence.loops);
  assembly.disturb(variant);
  return assembly.run(observer);
}

}  // namespace shapemap
