// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/pair_evidence.hpp"

#include <algorithm>

#include "matching_numbers.hpp"
#include "shapemap/matching/match_probability.hpp"

namespace shapemap {

bool shows_the_same(const MatchCandidate& pose) {
  const double total = std::max(pose.visibility.total(), 1e-9);
  const ReplacementNumbers& numbers = kMatching.replacement;
  return pose.visibility.agree > numbers.least_agree * total &&
         pose.visibility.crossed < numbers.most_crossed * total &&
         worst_deviation_m(pose_covariance(pose.fit)) < numbers.most_deviation_m;
}

}  // namespace shapemap
