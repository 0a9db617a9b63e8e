// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/inference/sweep_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "inference_numbers.hpp"
#include "shapemap/core/parallel_for.hpp"
#include "shapemap/inference/map_score.hpp"
#include "shapemap/matching/match_probability.hpp"

namespace shapemap {
namespace {

class Refinement {
 public:
  Refinement(const SweepViews& views, const NodePoses& nodes, const PointToLineOptions& line,
             const SweepRefinementOptions& options, int threads)
      : views_(views), part_of_node_(nodes.component_of_node), line_(line), options_(options), threads_(threads) {
    // All poses are solved for together, so the match of one pair takes a single step.
    line_.max_iterations = 1;
    line_.stiffness = kInference.sweeps.stiffness;
    poses_ = nodes.map_from_node;
    for (std::size_t node = 0; node < views.size(); ++node) {
      first_.push_back(poses_.size());
      poses_.insert(poses_.end(), views[node].size(), nodes.map_from_node[node]);
    }
    tie_sweeps();
  }

  void hold(const std::vector<PoseConstraint>& known) {
    const double slack = kInference.sweeps.known_slack;
    for (PoseConstraint constraint : known) {
      constraint.covariance *= slack * slack;
      constraint.loss_scale = kInference.agreement.match_loss;
      held_.push_back(constraint);
    }
  }

  void run_round(int round) {
    const SweepRefinementNumbers& numbers = kInference.sweeps;
    line_.first_gate_m = line_.last_gate_m =
        options_.gate_m * std::max(1.0, numbers.first_gate * std::pow(numbers.gate_shrinks, round));
    std::vector<PoseConstraint> constraints = held_;
    const std::vector<PoseConstraint> found = aligned_pairs();
    constraints.insert(constraints.end(), found.begin(), found.end());
    poses_ = solve_pose_graph(poses_, constraints).map_from_node;
  }

  SweepPoses result() const {
    SweepPoses result;
    for (std::size_t node = 0; node < views_.size(); ++node) {
      result.map_from_node.push_back(poses_[node]);
      result.node_from_sweep.emplace_back();
      for (std::size_t s = 0; s < views_[node].size(); ++s) {
        result.node_from_sweep.back().push_back(inverse(poses_[node]) * poses_[first_[node] + s]);
      }
    }
    return result;
  }

 private:
  struct Pair {
    std::size_t a;  ///< index in `poses_`
    std::size_t b;
    const ScanView* reference;
    const ScanView* query;
  };

  void tie_sweeps() {
    const double area_m2 = options_.sigma_m * options_.sigma_m;
    const Eigen::Matrix3d covariance =
        Eigen::Vector3d(area_m2, area_m2, options_.sigma_rad * options_.sigma_rad).asDiagonal();
    for (std::size_t node = 0; node < views_.size(); ++node) {
      for (std::size_t s = 0; s < views_[node].size(); ++s) {
        held_.push_back({node, first_[node] + s, {}, covariance, 0.0});
      }
    }
  }

  std::vector<Pair> pairs() const {
    const std::vector<Pose2> nodes(poses_.begin(), poses_.begin() + static_cast<std::ptrdiff_t>(views_.size()));
    std::vector<Pair> pairs;
    for (std::size_t a = 0; a < views_.size(); ++a) {
      for (std::size_t s = 0; s < views_[a].size(); ++s) {
        for (std::size_t t = s + 1; t < views_[a].size(); ++t) {
          pairs.push_back({first_[a] + s, first_[a] + t, views_[a][s].get(), views_[a][t].get()});
        }
      }
    }
    for (const auto& [a, b] : near_pairs(nodes, options_.within_m)) {
      if (part_of_node_[a] != part_of_node_[b]) continue;
      for (std::size_t s = 0; s < views_[a].size(); ++s) {
        for (std::size_t t = 0; t < views_[b].size(); ++t) {
          pairs.push_back({first_[a] + s, first_[b] + t, views_[a][s].get(), views_[b][t].get()});
        }
      }
    }
    return pairs;
  }

  std::vector<PoseConstraint> aligned_pairs() const {
    const std::vector<Pair> all = pairs();
    std::vector<std::optional<PoseConstraint>> found(all.size());
    parallel_for(all.size(), threads_, [&](std::size_t i) { found[i] = aligned(all[i]); });
    std::vector<PoseConstraint> constraints;
    for (const auto& constraint : found) {
      if (constraint) constraints.push_back(*constraint);
    }
    return constraints;
  }

  std::optional<PoseConstraint> aligned(const Pair& pair) const {
    const Pose2 expected = inverse(poses_[pair.a]) * poses_[pair.b];
    const LineFit fit = fit_to_lines(*pair.reference, *pair.query, expected, line_);
    const SweepRefinementNumbers& numbers = kInference.sweeps;
    if (fit.partners < options_.least_partners || !agrees(expected, fit.ref_from_query, numbers.most_off)) {
      return std::nullopt;
    }
    const LineNoise noise{numbers.noise_residual_m, numbers.noise_tangent};
    return PoseConstraint{pair.a, pair.b, fit.ref_from_query, pose_covariance(fit, noise),
                          kInference.agreement.match_loss};
  }

  const SweepViews& views_;
  const std::vector<std::size_t>& part_of_node_;
  PointToLineOptions line_;
  const SweepRefinementOptions& options_;
  int threads_;
  std::vector<Pose2> poses_;        ///< of the nodes, then of their sweeps
  std::vector<std::size_t> first_;  ///< of each node: its first sweep in `poses_`
  std::vector<PoseConstraint> held_;
};

}  // namespace

SweepPoses refine_sweeps(const SweepViews& views, const NodePoses& nodes, const PointToLineOptions& line,
                         const SweepRefinementOptions& options, const Execution& execution) {
  Refinement refinement(views, nodes, line, options, execution.threads);
  refinement.hold(nodes.known);
  for (int round = 0; round < options.rounds && execution.observer.keep_going(); ++round) refinement.run_round(round);
  return refinement.result();
}

}  // namespace shapemap
