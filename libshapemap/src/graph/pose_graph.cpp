// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/pose_graph.hpp"
#include "graph_numbers.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <stdexcept>

namespace shapemap {
namespace {

using Parameters = std::array<double, 3>;  // x, y, theta; the solver does not wrap the angle

Eigen::Matrix3d square_root_information(const Eigen::Matrix3d& covariance) {
  const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
  // A covariance of NaN passes the decomposition.
  if (!covariance.allFinite() || llt.info() != Eigen::Success)
    throw std::invalid_argument("a covariance is not positive definite");
  return llt.matrixL().solve(Eigen::Matrix3d::Identity());
}

/// Throws, since the solver would only print a warning and go on.
void require_finite(const Pose2& pose) {
  if (!std::isfinite(pose.x_m) || !std::isfinite(pose.y_m) || !std::isfinite(pose.theta_rad)) {
    throw std::invalid_argument("a pose is not finite");
  }
}

/// The difference of a relative pose and the measured one in the frame of the first node, weighted by the covariance.
class RelativePoseError : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit RelativePoseError(const PoseConstraint& constraint)
      : measured_(constraint.a_from_b), root_(square_root_information(constraint.covariance)) {}

  bool Evaluate(const double* const* nodes, double* residuals, double** jacobians) const override {
    const double* a = nodes[0];
    const double* b = nodes[1];
    const double cos_a = std::cos(a[2]);
    const double sin_a = std::sin(a[2]);
    const double dx = b[0] - a[0];
    const double dy = b[1] - a[1];
    const Eigen::Vector3d error(cos_a * dx + sin_a * dy - measured_.x_m, -sin_a * dx + cos_a * dy - measured_.y_m,
                                wrap_angle(b[2] - a[2] - measured_.theta_rad));
    Eigen::Map<Eigen::Vector3d>(residuals, 3) = root_ * error;
    if (jacobians == nullptr) return true;
    using Jacobian = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    Eigen::Matrix3d by_b;
    by_b << cos_a, sin_a, 0.0, -sin_a, cos_a, 0.0, 0.0, 0.0, 1.0;
    if (jacobians[0] != nullptr) {
      Eigen::Matrix3d by_a = -by_b;
      by_a(0, 2) = -sin_a * dx + cos_a * dy;
      by_a(1, 2) = -cos_a * dx - sin_a * dy;
      Eigen::Map<Jacobian> out(jacobians[0]);
      out = root_ * by_a;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Jacobian> out(jacobians[1]);
      out = root_ * by_b;
    }
    return true;
  }

 private:
  Pose2 measured_;
  Eigen::Matrix3d root_;
};

ceres::Solver::Options solver_options(int max_iterations) {
  ceres::Solver::Options options;
  // Only one thread and Eigen's solver give the same bits on every run.
  options.num_threads = 1;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = kGraph.solver.function_tolerance;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

PoseGraphSolution solve_pose_graph(const std::vector<Pose2>& map_from_node,
                                   const std::vector<PoseConstraint>& constraints, int max_iterations) {
  PoseGraphSolution solution{map_from_node, 0.0};
  if (constraints.empty()) return solution;
  const std::vector<std::size_t> part = connected_components(map_from_node.size(), constraints);
  std::vector<Parameters> nodes;
  nodes.reserve(map_from_node.size());
  for (const Pose2& pose : map_from_node) {
    require_finite(pose);
    nodes.push_back({pose.x_m, pose.y_m, pose.theta_rad});
  }

  // The problem owns neither, which would take it longer than to solve a small graph.
  std::deque<RelativePoseError> errors;
  std::map<double, ceres::CauchyLoss> losses;  // by scale
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (const PoseConstraint& constraint : constraints) {
    require_finite(constraint.a_from_b);
    errors.emplace_back(constraint);
    const double scale = constraint.loss_scale;
    ceres::LossFunction* loss = scale > 0.0 ? &losses.try_emplace(scale, scale).first->second : nullptr;
    problem.AddResidualBlock(&errors.back(), loss, nodes[constraint.a].data(), nodes[constraint.b].data());
  }
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    if (part[node] == node && problem.HasParameterBlock(nodes[node].data())) {
      problem.SetParameterBlockConstant(nodes[node].data());
    }
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(max_iterations), &problem, &summary);
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    solution.map_from_node[node] = {nodes[node][0], nodes[node][1], wrap_angle(nodes[node][2])};
  }
  solution.chi_square = 2.0 * summary.final_cost;
  return solution;
}

double squared_error(const PoseConstraint& constraint, const std::vector<Pose2>& map_from_node) {
  const Pose2& a = map_from_node.at(constraint.a);
  const Pose2& b = map_from_node.at(constraint.b);
  const Pose2 found = inverse(a) * b;
  const Eigen::Vector3d error(found.x_m - constraint.a_from_b.x_m, found.y_m - constraint.a_from_b.y_m,
                              wrap_angle(found.theta_rad - constraint.a_from_b.theta_rad));
  return error.dot(constraint.covariance.llt().solve(error));
}

double deviations_off(const PoseConstraint& one, const Pose2& other) {
  const SamePlaceNumbers& same = kGraph.same_place;
  if (angle_between(one.a_from_b.theta_rad, other.theta_rad) > same.heading_rad) {
    return std::numeric_limits<double>::infinity();
  }
  const Point2 off_m = other.translation() - one.a_from_b.translation();
  const Eigen::Matrix2d spread =
      one.covariance.topLeftCorner<2, 2>() + same.near_m * same.near_m * Eigen::Matrix2d::Identity();
  return std::sqrt(off_m.dot(spread.ldlt().solve(off_m)));
}

bool is_same_place(const PoseConstraint& one, const Pose2& other) {
  return deviations_off(one, other) < kGraph.same_place.deviations;
}

}  // namespace shapemap
