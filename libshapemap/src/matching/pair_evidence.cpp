// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/pair_evidence.hpp"

#include <algorithm>

#include "shapemap/matching/match_probability.hpp"

namespace shapemap {
namespace {

/// One scan replaces another when so many of their points agree, so few are crossed, and the pose is held so well.
constexpr double kLeastAgree = 0.55;
constexpr double kMostCrossed = 0.08;
constexpr double kMostDeviation_m = 0.10;

}  // namespace

bool shows_the_same(const MatchCandidate& pose) {
  const double total = std::max(pose.visibility.total(), 1e-9);
  return pose.visibility.agree > kLeastAgree * total && pose.visibility.crossed < kMostCrossed * total &&
         worst_deviation_m(pose_covariance(pose.fit)) < kMostDeviation_m;
}

}  // namespace shapemap
