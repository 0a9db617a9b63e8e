// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/point_to_line.hpp"
#include "matching_numbers.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace shapemap {
namespace {

/// The normal equations of one iteration.
struct LineSystem {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double squares_m2 = 0.0;
  double lever_squares_m2 = 0.0;
  int partners = 0;
};

/// The largest distance of a point from its partner, and the least cosine between their tangents.
struct PartnerGate {
  double distance_m;
  double cos_tangent;
};

/// Finds the nearest reference point of each query point. The partner of the last iteration bounds the distance of the
/// nearest point, so that each search is short.
class Partners {
 public:
  Partners(const ScanView& reference, std::size_t num_points) : reference_(reference), last_(num_points, kNone) {}

  /// Returns the nearest reference point of query point `i`, which is now at `p_m`.
  PointIndex::Neighbour nearest(std::size_t i, const Point2& p_m, double gate_m) {
    constexpr double kRounding = 1e-9;
    double within_m = gate_m;
    const std::size_t guess = last_[i] != kNone ? last_[i] : last_[i > 0 ? i - 1 : 0];
    if (guess != kNone) {
      const double distance_m = (reference_.points[guess].p_m - p_m).norm() * (1.0 + kRounding) + kRounding;
      within_m = std::min(within_m, distance_m);
    }
    const PointIndex::Neighbour near = reference_.index.nearest(p_m, within_m);
    if (near.distance_m <= gate_m) last_[i] = near.point;
    return near;
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  const ScanView& reference_;
  std::vector<std::size_t> last_;  ///< the last partner of each query point
};

LineSystem line_system(Partners& partners, const ScanView& reference, const ScanView& query,
                       const Pose2& ref_from_query, const PartnerGate& gate) {
  LineSystem system;
  const Turn turn(ref_from_query.theta_rad);
  const double trusted_m = kMatching.line_fit.trusted_share_of_gate * gate.distance_m;
  for (std::size_t i = 0; i < query.size(); ++i) {
    const Point2 turned_m = turn * query.points[i].p_m;
    const Point2 p_m = turned_m + ref_from_query.translation();
    const PointIndex::Neighbour near = partners.nearest(i, p_m, gate.distance_m);
    if (!(near.distance_m <= gate.distance_m)) continue;
    const Point2& tangent = reference.directions[near.point];
    if ((turn * query.directions[i]).dot(tangent) < gate.cos_tangent) continue;
    const Point2 normal(-tangent.y(), tangent.x());
    const double residual_m = normal.dot(p_m - reference.points[near.point].p_m);
    const double ratio = residual_m / trusted_m;
    const double weight = 1.0 / (1.0 + ratio * ratio);
    const Eigen::Vector3d jacobian(normal.x(), normal.y(), normal.dot(Point2(-turned_m.y(), turned_m.x())));
    system.a += weight * jacobian * jacobian.transpose();
    system.b -= weight * residual_m * jacobian;
    system.squares_m2 += residual_m * residual_m;
    system.lever_squares_m2 += turned_m.squaredNorm();
    ++system.partners;
  }
  return system;
}

void note_fit(const LineSystem& system, LineFit& fit) {
  const LineFitNumbers& numbers = kMatching.line_fit;
  fit.information = system.a;
  fit.partners = system.partners;
  if (fit.partners < numbers.least_partners) return;
  fit.rms_m = std::sqrt(system.squares_m2 / fit.partners);
  fit.lever_m = std::sqrt(system.lever_squares_m2 / fit.partners);
}

}  // namespace

LineFit fit_to_lines(const ScanView& reference, const ScanView& query, const Pose2& start,
                     const PointToLineOptions& options) {
  const LineFitNumbers& numbers = kMatching.line_fit;
  LineFit fit;
  fit.ref_from_query = start;
  Partners partners(reference, query.size());
  PartnerGate gate{std::max(options.first_gate_m, options.last_gate_m), std::cos(options.tangent_gate_rad)};
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    const LineSystem system = line_system(partners, reference, query, fit.ref_from_query, gate);
    note_fit(system, fit);
    if (fit.partners < numbers.least_partners) break;

    const Eigen::Matrix3d held = options.stiffness * fit.partners * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d step = (system.a + held + 1e-6 * Eigen::Matrix3d::Identity()).ldlt().solve(system.b);
    fit.ref_from_query.x_m += step.x();
    fit.ref_from_query.y_m += step.y();
    fit.ref_from_query.theta_rad = wrap_angle(fit.ref_from_query.theta_rad + step.z());
    const bool still = is_within({step.x(), step.y(), step.z()}, numbers.still);
    if (still && gate.distance_m <= options.last_gate_m) break;
    const double shrinks = still ? numbers.gate_shrinks_when_still : numbers.gate_shrinks;
    gate.distance_m = std::max(options.last_gate_m, shrinks * gate.distance_m);
  }
  return fit;
}

LineFit fit_at(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
               const PointToLineOptions& options) {
  LineFit fit;
  fit.ref_from_query = ref_from_query;
  Partners partners(reference, query.size());
  const PartnerGate gate{options.last_gate_m, std::cos(options.tangent_gate_rad)};
  note_fit(line_system(partners, reference, query, ref_from_query, gate), fit);
  return fit;
}

}  // namespace shapemap
