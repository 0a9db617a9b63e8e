// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/match_search.hpp"

#include <algorithm>
#include <cmath>

#include "matching_numbers.hpp"
#include "shapemap/matching/candidate_order.hpp"
#include "shapemap/matching/lcs_hypotheses.hpp"
#include "shapemap/matching/rotation_hypotheses.hpp"

namespace shapemap {
namespace {

MatchCandidate judged_fit(const ScanView& reference, const ScanView& query, const LineFit& fit,
                          const MatchSearchOptions& options) {
  MatchCandidate pose;
  pose.fit = fit;
  pose.ref_from_query = fit.ref_from_query;
  pose.visibility = visibility(reference, query, pose.ref_from_query, options.visibility);
  pose.score = visibility_score(pose.visibility) + kMatching.score.residual_per_m * pose.fit.rms_m;
  return pose;
}

/// Searches candidates for one pair of scans.
class Search {
 public:
  Search(const ScanView& reference, const ScanView& query, const MatchSearchOptions& options, const MotionPrior& prior)
      : reference_(reference),
        query_(query),
        options_(options),
        prior_(prior),
        max_shift_m_(max_shift_m(reference, query, options.voting)),
        voting_(reference, max_shift_m_, options.voting),
        shapes_(reference, query) {}

  std::vector<MatchCandidate> among(const std::vector<double>& rotations_rad, int peaks, int shape_segments) const {
    std::vector<MatchCandidate> coarse;
    for (const double rotation_rad : rotations_rad) {
      for (const Point2& shift_m : voting_.peaks(query_, rotation_rad, peaks)) {
        coarse.push_back(judged(shift_m, rotation_rad));
      }
      if (shape_segments == 0) continue;
      for (const Point2& shift_m : shapes_.translations(rotation_rad, shape_segments)) {
        if (shift_m.lpNorm<Eigen::Infinity>() > max_shift_m_) continue;
        coarse.push_back(judged(shift_m, rotation_rad));
      }
    }
    std::stable_sort(coarse.begin(), coarse.end(), is_more_likely);
    if (coarse.size() > static_cast<std::size_t>(options_.candidates.refined)) {
      coarse.resize(static_cast<std::size_t>(options_.candidates.refined));
    }
    std::vector<MatchCandidate> fine;
    fine.reserve(coarse.size());
    for (const MatchCandidate& pose : coarse) {
      fine.push_back(refined_candidate(reference_, query_, pose.ref_from_query, options_));
      fine.back().score -= prior_.surprise(fine.back().ref_from_query);
    }
    return best_distinct(std::move(fine), options_.candidates.kept);
  }

 private:
  MatchCandidate judged(const Point2& shift_m, double rotation_rad) const {
    MatchCandidate pose;
    pose.ref_from_query = {shift_m.x(), shift_m.y(), rotation_rad};
    const CandidateNumbers& numbers = kMatching.candidates;
    pose.score = visibility_score(visibility(reference_, query_, pose.ref_from_query, options_.visibility,
                                             {numbers.coarse_slack, numbers.coarse_stride}));
    pose.score -= prior_.surprise(pose.ref_from_query);
    return pose;
  }

  const ScanView& reference_;
  const ScanView& query_;
  const MatchSearchOptions& options_;
  const MotionPrior& prior_;
  double max_shift_m_;
  TranslationVoting voting_;
  LcsHypotheses shapes_;
};

std::vector<double> all_rotations(double step_rad) {
  std::vector<double> rotations_rad;
  const auto count = static_cast<int>(std::ceil(2.0 * kPi / step_rad));
  rotations_rad.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) rotations_rad.push_back(wrap_angle(k * step_rad));
  return rotations_rad;
}

}  // namespace

std::vector<MatchCandidate> find_candidates(const ScanView& reference, const ScanView& query,
                                            const MatchSearchOptions& options) {
  const MotionPrior flat;
  const Search search(reference, query, options, flat);
  std::vector<MatchCandidate> found =
      search.among(rotation_hypotheses(reference.tangents, query.tangents, options.candidates.rotation_peaks),
                   options.voting.peaks, options.candidates.shape_segments);
  if (!found.empty() && found.front().score >= options.candidates.all_rotations_below) return found;
  // Where the scans have few lines, or little in common, tangents alone do not determine the rotation.
  const int peaks = std::max(1, options.voting.peaks / kMatching.candidates.all_rotations_fewer_peaks);
  std::vector<MatchCandidate> more = search.among(all_rotations(options.candidates.all_rotations_step_rad), peaks, 0);
  more.insert(more.end(), found.begin(), found.end());
  return best_distinct(std::move(more), options.candidates.kept);
}

std::vector<MatchCandidate> find_usual_candidates(const ScanView& reference, const ScanView& query,
                                                  const MatchSearchOptions& options, const MotionPrior& prior) {
  MatchSearchOptions thorough = options;
  for (int* effort : {&thorough.candidates.rotation_peaks, &thorough.candidates.refined, &thorough.voting.peaks}) {
    *effort *= kMatching.candidates.usual_effort;
  }
  const Search search(reference, query, thorough, prior);
  return search.among(rotation_hypotheses(reference.tangents, query.tangents, thorough.candidates.rotation_peaks),
                      thorough.voting.peaks, thorough.candidates.shape_segments);
}

MatchCandidate refined_candidate(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                                 const MatchSearchOptions& options) {
  return judged_fit(reference, query, fit_to_lines(reference, query, ref_from_query, options.line), options);
}

MatchCandidate candidate_at(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                            const MatchSearchOptions& options) {
  return judged_fit(reference, query, fit_at(reference, query, ref_from_query, options.line), options);
}

std::vector<MatchCandidate> best_distinct(std::vector<MatchCandidate> candidates, int count) {
  std::stable_sort(candidates.begin(), candidates.end(), is_more_likely);
  std::vector<MatchCandidate> distinct;
  for (const MatchCandidate& pose : candidates) {
    if (distinct.size() == static_cast<std::size_t>(count)) break;
    add_if_new(pose, distinct);
  }
  return distinct;
}

void add_if_new(const MatchCandidate& pose, std::vector<MatchCandidate>& distinct) {
  const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const MatchCandidate& other) {
    return agrees(other.ref_from_query, pose.ref_from_query, kMatching.candidates.same_place);
  });
  if (!known) distinct.push_back(pose);
}

}  // namespace shapemap
