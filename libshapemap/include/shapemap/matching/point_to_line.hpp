// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "shapemap/core/options.hpp"
#include "shapemap/shape/scan_view.hpp"

namespace shapemap {

struct PointToLineOptions {
  double first_gate_m = 0.50;
  double last_gate_m = 0.15;
  double tangent_gate_rad = 20 * kDegree;
  int max_iterations = 12;
  double stiffness = 0.02;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"line-first-gate-m", "partners of the first iteration are at most this far apart [m]", 0.01, 10},
          self.first_gate_m);
    visit(Field{"line-last-gate-m", "partners of the last [m]", 0.01, 10}, self.last_gate_m);
    visit(Field{"line-tangent-gate-deg", "and have tangents within this angle [deg]", 1, 180, kDegree},
          self.tangent_gate_rad);
    visit(Field{"line-stiffness", "resistance to sliding along lines, as a share of the partners", 0, 10},
          self.stiffness);
    visit(Field{"line-max-iterations", "iterations of the refinement", 0, 1000}, self.max_iterations);
  }
};

struct LineFit {
  Pose2 ref_from_query;
  /// The information about (x, y, theta) at the last iteration: weighted sum of J^T J over the partners, for residuals
  /// of unit variance.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int partners = 0;      ///< query points that have a partner in the reference
  double rms_m = 0.0;    ///< root mean square of their distances from the partners' lines
  double lever_m = 0.0;  ///< root mean square of their distances from the robot
};

/// Moves the query from `start` so that its points lie on the lines through their partners in the reference (Chen and
/// Medioni, "Object modelling by registration of multiple range images", 1992). The gate for partners narrows from one
/// iteration to the next.
LineFit fit_to_lines(const ScanView& reference, const ScanView& query, const Pose2& start,
                     const PointToLineOptions& options);

/// Returns the fit at a pose as it is, with the gate of the last iteration.
LineFit fit_at(const ScanView& reference, const ScanView& query, const Pose2& ref_from_query,
               const PointToLineOptions& options);

}  // namespace shapemap
