// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/match_probability.hpp"
#include "matching_numbers.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

/// Returns the variances of (x, y) along the principal axes, the smaller first.
Eigen::Vector2d position_variances(const Eigen::Matrix3d& covariance) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(Eigen::Matrix2d(covariance.topLeftCorner<2, 2>()))
      .eigenvalues();
}

}  // namespace

double lead_of_first(const std::vector<MatchCandidate>& candidates) {
  return candidates.size() > 1 ? candidates[0].score - candidates[1].score : kFullMargin;
}

double log_odds_of(double probability) { return std::log(probability / (1.0 - probability)); }

double probability_of(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

double match_probability(const MatchCandidate& best, double margin) {
  const MatchProbabilityWeights& weights = kMatching.match_probability;
  const double agree = best.visibility.agree / std::max(best.visibility.total(), 1e-9);
  const double lead = std::clamp(margin, weights.least_margin, weights.full_margin);
  const double log_odds = weights.constant + weights.per_margin * lead + weights.per_log_margin * std::log(lead) +
                          weights.per_score * best.score +
                          weights.per_log_agree * std::log(weights.agree_offset + agree);
  // The margin bounds the log odds, because of two places that fit alike, each is right half of the time.
  return probability_of(std::min(log_odds, lead));
}

double odometry_probability(double match_probability, double insufficient_view) {
  const double least = 1e-9;  // keeps the logarithm finite
  const double match = log_odds_of(std::clamp(match_probability, least, 1.0 - least));
  const OdometryProbabilityWeights& weights = kMatching.odometry_probability;
  return probability_of(weights.constant + weights.per_log_odds * match +
                        weights.per_insufficient_view * insufficient_view);
}

double insufficient_view(const ScanView& a, const ScanView& b) {
  return std::max(0.0, kMatching.odometry_probability.enough_view - std::min(a.seen_share, b.seen_share));
}

Eigen::Matrix3d pose_covariance(const LineFit& fit, const LineNoise& noise) {
  // Angles are scaled to the metres by which they move a point, so that all eigenvalues are comparable.
  const double lever_m = std::max(fit.lever_m, kMatching.covariance.least_lever_m);
  const Eigen::Vector3d scale(1.0, 1.0, 1.0 / lever_m);
  const Eigen::Matrix3d information = scale.asDiagonal() * fit.information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  const double seeming = noise.tangent * noise.tangent * fit.partners;
  const double share_of_unknown = noise.residual_m / kMatching.covariance.unknown_m;
  const double least = share_of_unknown * share_of_unknown;
  const Eigen::Vector3d variances =
      noise.residual_m * noise.residual_m * (eigen.eigenvalues().array() - seeming).max(least).inverse().matrix();
  const Eigen::Matrix3d scaled = eigen.eigenvectors() * variances.asDiagonal() * eigen.eigenvectors().transpose();
  return scale.asDiagonal() * scaled * scale.asDiagonal();
}

double worst_deviation_m(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, position_variances(covariance).maxCoeff()));
}

double best_deviation_m(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, position_variances(covariance).minCoeff()));
}

}  // namespace shapemap
