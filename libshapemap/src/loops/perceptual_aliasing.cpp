// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/loops/perceptual_aliasing.hpp"
#include "loops_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace shapemap {
namespace {

/// Knows the relative poses of nodes by sure odometry edges, and their variance.
class SureChain {
 public:
  SureChain(const std::vector<Edge>& edges, const std::vector<Pose2>& map_of_odometry, double sure_probability)
      : map_from_node_(map_of_odometry), submap_(map_of_odometry.size(), 0), variance_m2_(map_of_odometry.size(), 0.0) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const bool is_sure = edges[i].exists() && edges[i].probability >= sure_probability;
      submap_[i + 1] = submap_[i] + (is_sure ? 0 : 1);
      variance_m2_[i + 1] = variance_m2_[i];
      if (is_sure) variance_m2_[i + 1] += variance_m2(edges[i].candidates.front().covariance);
    }
  }

  bool contradicts(const EdgeCandidate& one) const {
    const AliasingNumbers& numbers = kLoops.aliasing;
    if (submap_[one.a] != submap_[one.b] || one.b - one.a > numbers.long_chain) return false;
    const double deviation_m = std::sqrt(variance_m2_[one.b] - variance_m2_[one.a] + variance_m2(one.covariance));
    const PoseTolerance off{numbers.contradicts.m + numbers.deviations * deviation_m, numbers.contradicts.rad};
    return !agrees(one.a_from_b, inverse(map_from_node_[one.a]) * map_from_node_[one.b], off);
  }

 private:
  static double variance_m2(const Eigen::Matrix3d& covariance) { return covariance(0, 0) + covariance(1, 1); }

  const std::vector<Pose2>& map_from_node_;
  std::vector<std::size_t> submap_;
  std::vector<double> variance_m2_;  ///< of the position, summed over the sure edges from the first node on
};

}  // namespace

std::vector<EdgeCandidate> without_aliases(const std::vector<EdgeCandidate>& candidates, const std::vector<Edge>& edges,
                                           const std::vector<Pose2>& map_of_odometry, double sure_probability) {
  // A match with less log odds than this has no worth in a cluster anyway.
  const double least_log_odds = -kLoops.members.prior;
  const std::size_t near = kLoops.aliasing.near;
  const std::size_t count = map_of_odometry.size();
  if (edges.size() >= std::max<std::size_t>(count, 1)) throw std::invalid_argument("more links than nodes to join");
  const SureChain chain(edges, map_of_odometry, sure_probability);
  std::vector<EdgeCandidate> kept;
  std::vector<double> alike(count, least_log_odds);
  for (const EdgeCandidate& one : candidates) {
    if (!chain.contradicts(one)) {
      kept.push_back(one);
      continue;
    }
    for (const std::size_t n : {one.a, one.b}) {
      for (std::size_t m = n - std::min(n, near); m < std::min(count, n + near + 1); ++m) {
        alike[m] = std::max(alike[m], one.score);
      }
    }
  }
  for (EdgeCandidate& one : kept) one.score -= std::max(alike[one.a], alike[one.b]) - least_log_odds;
  return kept;
}

}  // namespace shapemap
