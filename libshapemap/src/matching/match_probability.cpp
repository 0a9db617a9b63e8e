// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/match_probability.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

/// As far as a position can be off and still be near.
constexpr double kUnknown_m = 10.0;

/// In the directions in which it is held best and worst.
Eigen::Vector2d variances_of_place(const Eigen::Matrix3d& covariance) {
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
  constexpr double kLeastMargin = 0.05;  // its logarithm stays finite
  constexpr double kLeastAgree = 0.02;
  const double agree = best.visibility.agree / std::max(best.visibility.total(), 1e-9);
  const double lead = std::clamp(margin, kLeastMargin, kFullMargin);
  // Logistic regression on pairs of scans with known poses, and on pairs of different places, by
  // scripts/evaluate.py fit-scores.
  const double log_odds =
      -0.34 + 0.61 * lead + 0.28 * std::log(lead) + 0.58 * best.score + 1.07 * std::log(kLeastAgree + agree);
  // However well the best place fits: of two that fit alike, each is right half of the time.
  return probability_of(std::min(log_odds, lead));
}

double odometry_probability(double match_probability, double insufficient_view) {
  constexpr double kLeast = 1e-9;  // the logarithm stays finite
  const double match = log_odds_of(std::clamp(match_probability, kLeast, 1.0 - kLeast));
  // Logistic regression on links that no loop holds, of thinned logs and simulated arenas; the last weight on those of
  // hard scenes: scripts/evaluate.py fit-edges.
  return probability_of(3.0 + 0.48 * match - 12.0 * insufficient_view);
}

double insufficient_view(const ScanView& a, const ScanView& b) {
  constexpr double kEnough = 0.45;  // half a circle has some slack
  return std::max(0.0, kEnough - std::min(a.seen_share, b.seen_share));
}

Eigen::Matrix3d pose_covariance(const LineFit& fit, const LineNoise& noise) {
  // Angles are scaled to the metres that they move a point by, so that all eigenvalues compare.
  const double lever_m = std::max(fit.lever_m, 0.1);
  const Eigen::Vector3d scale(1.0, 1.0, 1.0 / lever_m);
  const Eigen::Matrix3d information = scale.asDiagonal() * fit.information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  const double seeming = noise.tangent * noise.tangent * fit.partners;
  const double least = (noise.residual_m / kUnknown_m) * (noise.residual_m / kUnknown_m);
  const Eigen::Vector3d variances =
      noise.residual_m * noise.residual_m * (eigen.eigenvalues().array() - seeming).max(least).inverse().matrix();
  const Eigen::Matrix3d scaled = eigen.eigenvectors() * variances.asDiagonal() * eigen.eigenvectors().transpose();
  return scale.asDiagonal() * scaled * scale.asDiagonal();
}

double worst_deviation_m(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, variances_of_place(covariance).maxCoeff()));
}

double best_deviation_m(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, variances_of_place(covariance).minCoeff()));
}

}  // namespace shapemap
