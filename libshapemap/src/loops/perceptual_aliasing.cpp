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
  SureChain(const std::vector<ChainLink>& links, const std::vector<Pose2>& map_of_chain)
      : map_from_node_(map_of_chain), piece_(map_of_chain.size(), 0), variance_m2_(map_of_chain.size(), 0.0) {
    for (std::size_t i = 0; i < links.size(); ++i) {
      const bool is_sure = links[i].exists() && links[i].probability >= kSure;
      piece_[i + 1] = piece_[i] + (is_sure ? 0 : 1);
      variance_m2_[i + 1] = variance_m2_[i];
      if (is_sure) variance_m2_[i + 1] += variance_m2(links[i].alternatives.front().covariance);
    }
  }

  bool contradicts(const LoopHypothesis& one) const {
    if (piece_[one.a] != piece_[one.b] || one.b - one.a > kLongest) return false;
    const Pose2 off = inverse(one.a_from_b) * (inverse(map_from_node_[one.a]) * map_from_node_[one.b]);
    const double deviation_m = std::sqrt(variance_m2_[one.b] - variance_m2_[one.a] + variance_m2(one.covariance));
    return !is_within(off, kLeastOff_m + kDeviations * deviation_m, kLeastOff_rad);
  }

 private:
  static double variance_m2(const Eigen::Matrix3d& covariance) { return covariance(0, 0) + covariance(1, 1); }

  const std::vector<Pose2>& map_from_node_;
  std::vector<std::size_t> piece_;
  std::vector<double> variance_m2_;  ///< from the first node on
};

}  // namespace

std::vector<LoopHypothesis> without_look_alikes(const std::vector<LoopHypothesis>& hypotheses,
                                                const std::vector<ChainLink>& links,
                                                const std::vector<Pose2>& map_of_chain) {
  const std::size_t count = map_of_chain.size();
  if (links.size() >= std::max<std::size_t>(count, 1)) throw std::invalid_argument("more links than nodes to join");
  const SureChain chain(links, map_of_chain);
  std::vector<LoopHypothesis> kept;
  std::vector<double> alike(count, kLeastLogOdds);
  for (const LoopHypothesis& one : hypotheses) {
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
  for (LoopHypothesis& one : kept) one.log_odds -= std::max(alike[one.a], alike[one.b]) - kLeastLogOdds;
  return kept;
}

}  // namespace shapemap
