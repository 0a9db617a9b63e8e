// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/loops/perceptual_aliasing.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace shapemap {
namespace {

/// Links that are at least so probable are not questioned here, but so many in a row are not all right.
constexpr double kSure = 0.97;
constexpr std::size_t kLongest = 40;

/// What the chain contradicts is off by more than this, and by so many standard deviations.
constexpr double kLeastOff_m = 2.0;
constexpr double kLeastOff_rad = 30 * kDegree;
constexpr double kDeviations = 4.0;

/// Nodes so near along the chain look alike as well.
constexpr std::size_t kNear = 2;

/// Hypotheses with lower odds count for nothing anyway.
constexpr double kLeastLogOdds = -2.0;

/// How surely the chain knows where its nodes are to each other.
class SureChain {
 public:
  SureChain(const std::vector<EdgeChoices>& edges, const std::vector<Pose2>& map_of_odometry)
      : map_from_node_(map_of_odometry), submap_(map_of_odometry.size(), 0), variance_m2_(map_of_odometry.size(), 0.0) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const bool is_sure = edges[i].exists() && edges[i].probability >= kSure;
      submap_[i + 1] = submap_[i] + (is_sure ? 0 : 1);
      variance_m2_[i + 1] = variance_m2_[i];
      if (is_sure) variance_m2_[i + 1] += variance_m2(edges[i].candidates.front().covariance);
    }
  }

  bool contradicts(const LoopCandidate& one) const {
    if (submap_[one.a] != submap_[one.b] || one.b - one.a > kLongest) return false;
    const Pose2 off = inverse(one.a_from_b) * (inverse(map_from_node_[one.a]) * map_from_node_[one.b]);
    const double deviation_m = std::sqrt(variance_m2_[one.b] - variance_m2_[one.a] + variance_m2(one.covariance));
    return !is_within(off, kLeastOff_m + kDeviations * deviation_m, kLeastOff_rad);
  }

 private:
  static double variance_m2(const Eigen::Matrix3d& covariance) { return covariance(0, 0) + covariance(1, 1); }

  const std::vector<Pose2>& map_from_node_;
  std::vector<std::size_t> submap_;
  std::vector<double> variance_m2_;  ///< from the first node on
};

}  // namespace

std::vector<LoopCandidate> without_aliases(const std::vector<LoopCandidate>& candidates,
                                           const std::vector<EdgeChoices>& edges,
                                           const std::vector<Pose2>& map_of_odometry) {
  const std::size_t count = map_of_odometry.size();
  if (edges.size() >= std::max<std::size_t>(count, 1)) throw std::invalid_argument("more links than nodes to join");
  const SureChain chain(edges, map_of_odometry);
  std::vector<LoopCandidate> kept;
  std::vector<double> alike(count, kLeastLogOdds);
  for (const LoopCandidate& one : candidates) {
    if (!chain.contradicts(one)) {
      kept.push_back(one);
      continue;
    }
    for (const std::size_t n : {one.a, one.b}) {
      for (std::size_t m = n - std::min(n, kNear); m < std::min(count, n + kNear + 1); ++m) {
        alike[m] = std::max(alike[m], one.log_odds);
      }
    }
  }
  for (LoopCandidate& one : kept) one.log_odds -= std::max(alike[one.a], alike[one.b]) - kLeastLogOdds;
  return kept;
}

}  // namespace shapemap
