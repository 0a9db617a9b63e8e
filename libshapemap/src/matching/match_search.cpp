// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/match_search.hpp"

#include <algorithm>
#include <cmath>

#include "shapemap/matching/lcs_hypotheses.hpp"
#include "shapemap/matching/rotation_hypotheses.hpp"

namespace shapemap {
namespace {

/// Poses closer than this are one and the same after refinement.
constexpr double kSamePlace_m = 0.20;
constexpr double kSameHeading_rad = 5 * kDegree;

/// Before refinement, poses are off by up to a cell of the votes: distances are taken this much wider.
constexpr double kCoarseSlack = 2.0;
constexpr std::size_t kCoarseStride = 2;

constexpr double kScorePerResidual_m = 56.0;

/// Where the usual is looked for, so many times as many poses are put up and refined.
constexpr int kMoreUsual = 2;

bool better(const PoseHypothesis& a, const PoseHypothesis& b) { return a.score > b.score; }

bool same_place(const Pose2& a, const Pose2& b) {
  return (a.translation() - b.translation()).norm() < kSamePlace_m &&
         angle_between(a.theta_rad, b.theta_rad) < kSameHeading_rad;
}

PoseHypothesis judged_fit(const ScanView& reference, const ScanView& query, const LineFit& fit,
                          const HypothesisSearchOptions& options) {
  PoseHypothesis pose;
  pose.fit = fit;
  pose.ref_from_query = fit.ref_from_query;
  pose.visibility = visibility(reference, query, pose.ref_from_query, options.visibility);
  pose.score = visibility_score(pose.visibility) - kScorePerResidual_m * pose.fit.rms_m;
  return pose;
}

/// The two scans of an alignment and what their hypotheses come from.
class Search {
 public:
  Search(const ScanView& reference, const ScanView& query, const HypothesisSearchOptions& options,
         const MotionHabit& habit)
      : reference_(reference),
        query_(query),
        options_(options),
        habit_(habit),
        max_shift_m_(max_shift_m(reference, query, options.voting)),
        voting_(reference, max_shift_m_, options.voting),
        shapes_(reference, query) {}

  std::vector<PoseHypothesis> among(const std::vector<double>& rotations_rad, int peaks, int shape_segments) const {
    std::vector<PoseHypothesis> coarse;
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
    std::stable_sort(coarse.begin(), coarse.end(), better);
    if (coarse.size() > static_cast<std::size_t>(options_.hypotheses.refined)) {
      coarse.resize(static_cast<std::size_t>(options_.hypotheses.refined));
    }
    std::vector<PoseHypothesis> fine;
    fine.reserve(coarse.size());
    for (const PoseHypothesis& pose : coarse) {
      fine.push_back(refined_hypothesis(reference_, query_, pose.ref_from_query, options_));
      fine.back().score -= habit_.surprise(fine.back().ref_from_query);
    }
    return best_distinct(std::move(fine), options_.hypotheses.kept);
  }

 private:
  PoseHypothesis judged(const Point2& shift_m, double rotation_rad) const {
    PoseHypothesis pose;
    pose.ref_from_query = {shift_m.x(), shift_m.y(), rotation_rad};
    pose.score = visibility_score(
        visibility(reference_, query_, pose.ref_from_query, options_.visibility, kCoarseSlack, kCoarseStride));
    pose.score -= habit_.surprise(pose.ref_from_query);
    return pose;
  }

  const ScanView& reference_;
  const ScanView& query_;
  const HypothesisSearchOptions& options_;
  const MotionHabit& habit_;
  double max_shift_m_;
  TranslationVoting voting_;
  ShapeHypotheses shapes_;
};

std::vector<double> all_rotations(double step_rad) {
  std::vector<double> rotations_rad;
  const auto count = static_cast<int>(std::ceil(2.0 * kPi / step_rad));
  rotations_rad.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) rotations_rad.push_back(wrap_angle(k * step_rad));
  return rotations_rad;
}

}  // namespace

std::vector<PoseHypothesis> pose_hypotheses(const ScanView& reference, const ScanView& query,
                                            const HypothesisSearchOptions& options) {
  const MotionHabit any;
  const Search search(reference, query, options, any);
  std::vector<PoseHypothesis> found =
      search.among(rotation_hypotheses(reference.tangents, query.tangents, options.hypotheses.rotation_peaks),
                   options.voting.peaks, options.hypotheses.shape_segments);
  if (!found.empty() && found.front().score >= options.hypotheses.all_rotations_below) return found;
  // Few lines, or little in common: tangents alone do not tell the rotation.
  std::vector<PoseHypothesis> more =
      search.among(all_rotations(options.hypotheses.all_rotations_step_rad), std::max(1, options.voting.peaks / 4), 0);
  more.insert(more.end(), found.begin(), found.end());
  return best_distinct(std::move(more), options.hypotheses.kept);
}

std::vector<PoseHypothesis> usual_hypotheses(const ScanView& reference, const ScanView& query,
                                             const HypothesisSearchOptions& options, const MotionHabit& habit) {
  HypothesisSearchOptions thorough = options;
  for (int* effort : {&thorough.hypotheses.rotation_peaks, &thorough.hypotheses.refined, &thorough.voting.peaks}) {
    *effort *= kMoreUsual;
  }
  const Search search(reference, query, thorough, habit);
  return search.among(rotation_hypotheses(reference.tangents, query.tangents, thorough.hypotheses.rotation_peaks),
                      thorough.voting.peaks, thorough.hypotheses.shape_segments);
}

PoseHypothesis refined_hypothesis(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                                  const HypothesisSearchOptions& options) {
  return judged_fit(reference, query, fit_to_lines(reference, query, ref_from_query, options.line), options);
}

PoseHypothesis hypothesis_at(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
                             const HypothesisSearchOptions& options) {
  return judged_fit(reference, query, fit_at(reference, query, ref_from_query, options.line), options);
}

std::vector<PoseHypothesis> best_distinct(std::vector<PoseHypothesis> hypotheses, int count) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(), better);
  std::vector<PoseHypothesis> distinct;
  for (const PoseHypothesis& pose : hypotheses) {
    if (distinct.size() == static_cast<std::size_t>(count)) break;
    add_if_new(pose, distinct);
  }
  return distinct;
}

void add_if_new(const PoseHypothesis& pose, std::vector<PoseHypothesis>& distinct) {
  const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const PoseHypothesis& other) {
    return same_place(other.ref_from_query, pose.ref_from_query);
  });
  if (!known) distinct.push_back(pose);
}

}  // namespace shapemap
