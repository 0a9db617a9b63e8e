// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/scan_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace shapemap {
namespace {

std::string text_of(const char* before, double value, const char* after) {
  std::ostringstream stream;
  stream.precision(3);
  stream << before << value << after;
  return stream.str();
}

void give_verdict(ScanMatch& match, double agree, const ConfidenceOptions& options) {
  const double deviation_m = worst_deviation_m(match.covariance);
  if (agree < options.min_agree) {
    match.status = MatchStatus::kTooLittleOverlap;
    match.reason = text_of("only a share of ", agree, " of the points agrees with what the other scan saw");
    match.ref_from_query = kNoPose;
  } else if (match.probability < options.sure_probability) {
    match.status = MatchStatus::kAmbiguous;
    match.reason = text_of("the pose is right with a probability of ", match.probability, " only");
  } else if (deviation_m > options.max_deviation_m) {
    match.status = MatchStatus::kDegenerate;
    match.reason = text_of("in one direction the position is known to ", deviation_m, " m only");
  } else {
    match.status = MatchStatus::kOk;
  }
}

}  // namespace

RankedPose ranked_pose(const MatchCandidate& pose) {
  constexpr double kNothing = 1e-9;
  const Visibility& v = pose.visibility;
  const double total = std::max(v.total(), kNothing);
  RankedPose ranked;
  ranked.ref_from_query = pose.ref_from_query;
  ranked.score = pose.score;
  ranked.agree = v.agree / total;
  ranked.crossed = v.crossed / total;
  ranked.hidden = v.hidden / total;
  ranked.unclear = v.unclear / total;
  ranked.outside = v.outside / total;
  ranked.cross_agree = v.cross_agree / std::max(v.cross_total, kNothing);
  ranked.rms_m = pose.fit.rms_m;
  ranked.partners = pose.fit.partners;
  return ranked;
}

ScanMatch judged(const std::vector<MatchCandidate>& candidates, std::size_t chosen, double margin,
                 const ConfidenceOptions& options, std::optional<double> probability) {
  ScanMatch match;
  if (candidates.empty()) {
    match.status = MatchStatus::kNoCandidates;
    match.reason = "no pose brings similar surfaces together";
    return match;
  }
  const MatchCandidate& best = candidates.at(chosen);
  match.ref_from_query = best.ref_from_query;
  match.probability = probability ? *probability : match_probability(best, margin);
  match.covariance = pose_covariance(best.fit);
  match.ranked.push_back(ranked_pose(best));
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i != chosen) match.ranked.push_back(ranked_pose(candidates[i]));
  }
  // Multi-reference candidates come behind the others, in no order.
  std::stable_sort(match.ranked.begin() + 1, match.ranked.end(),
                   [](const RankedPose& a, const RankedPose& b) { return a.score > b.score; });
  give_verdict(match, match.ranked.front().agree, options);
  return match;
}

ScanMatch match_scans(const ScanView& reference, const ScanView& query, const MatcherOptions& options) {
  const std::vector<MatchCandidate> poses = find_candidates(reference, query, options.search);
  return judged(poses, 0, lead_of_first(poses), options.confidence);
}

}  // namespace shapemap
