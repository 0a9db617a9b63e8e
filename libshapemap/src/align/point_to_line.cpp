// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/align/point_to_line.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace shapemap {

LineFit fit_to_lines(const ScanView& reference, const ScanView& query, const Pose2& start,
                     const PointToLineOptions& options) {
  LineFit fit;
  fit.ref_from_query = start;
  const double cos_gate = std::cos(options.tangent_gate_rad);
  double gate_m = options.first_gate_m;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    const double c = std::cos(fit.ref_from_query.theta_rad);
    const double s = std::sin(fit.ref_from_query.theta_rad);
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    double squares = 0.0;
    fit.partners = 0;
    for (std::size_t i = 0; i < query.size(); ++i) {
      const Point2& q = query.points[i].p_m;
      const Point2 turned(c * q.x() - s * q.y(), s * q.x() + c * q.y());
      const Point2 p = turned + fit.ref_from_query.translation();
      const PointIndex::Neighbour near = reference.index.nearest(p, gate_m);
      if (!(near.distance_m <= gate_m)) continue;
      const Point2& d = query.directions[i];
      const Point2& t = reference.directions[near.point];
      if ((c * d.x() - s * d.y()) * t.x() + (s * d.x() + c * d.y()) * t.y() < cos_gate) continue;
      const Point2 normal(-t.y(), t.x());
      const double residual_m = normal.dot(p - reference.points[near.point].p_m);
      const double ratio = residual_m / (0.3 * gate_m);
      const double weight = 1.0 / (1.0 + ratio * ratio);
      const Eigen::Vector3d j(normal.x(), normal.y(), normal.dot(Point2(-turned.y(), turned.x())));
      a += weight * j * j.transpose();
      b -= weight * residual_m * j;
      squares += residual_m * residual_m;
      ++fit.partners;
    }
    fit.information = a;
    if (fit.partners < 3) return fit;
    fit.rms_m = std::sqrt(squares / fit.partners);
    // A direction that no line holds stays where it is.
    const double stiffness = options.stiffness * fit.partners + 1e-6;
    const Eigen::Vector3d step = (a + Eigen::Vector3d(stiffness, stiffness, stiffness).asDiagonal().toDenseMatrix()).ldlt().solve(b);
    fit.ref_from_query.x_m += step.x();
    fit.ref_from_query.y_m += step.y();
    fit.ref_from_query.theta_rad = wrap_angle(fit.ref_from_query.theta_rad + step.z());
    const bool still = step.head<2>().norm() < 1e-3 && std::abs(step.z()) < 1e-3;
    if (still && gate_m <= options.last_gate_m) break;
    gate_m = std::max(options.last_gate_m, still ? 0.5 * gate_m : 0.8 * gate_m);
  }
  return fit;
}

}  // namespace shapemap
