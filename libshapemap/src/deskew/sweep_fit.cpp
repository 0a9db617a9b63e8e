// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "banded_system.hpp"
#include "shapemap/core/parallel_for.hpp"

namespace shapemap {
namespace {

/// Each sweep is compared with so many after it.
constexpr std::size_t kReach = 2;

/// A point off its surface has this standard deviation; it allows for neighbouring points that err alike.
constexpr double kResidual_m = 0.03;

/// The third difference of control points one second apart has this standard deviation, which fits hands and heads.
constexpr double kJerk_m_s3 = 40.0;
constexpr double kJerk_rad_s3 = 100.0;

/// Partners farther apart than this share of the gate count less and less.
constexpr double kTrustedShareOfGate = 0.3;
const double kCosTangentGate = std::cos(35 * kDegree);

/// The points of a sweep are linearised in the control points that they depend on.
struct Linearised {
  PlacedSweep placed;
  std::vector<SweepTrajectory::Support> supports;
  std::vector<Point2> turned_m;  ///< from the robot, in the directions of the map
};

Linearised linearised(const TimedSweep& sweep, const SweepTrajectory& trajectory) {
  Linearised result;
  result.placed = placed_sweep(sweep, trajectory);
  result.supports.reserve(sweep.points.size());
  result.turned_m.reserve(sweep.points.size());
  for (std::size_t k = 0; k < sweep.points.size(); ++k) {
    result.supports.push_back(trajectory.support(sweep.points[k].time_s));
    const Eigen::Vector3d at = trajectory.at(result.supports.back());
    result.turned_m.push_back(result.placed.p_m[k] - at.head<2>());
  }
  return result;
}

/// A block has the normal equations that one sweep shares with those after it.
struct Block {
  std::size_t first = 0;  ///< index of the first control point
  Eigen::MatrixXd a;
  Eigen::VectorXd b;

  void add(std::size_t fu, std::size_t fv, const Eigen::Matrix<double, 24, Eigen::Dynamic>& columns,
           const Eigen::VectorXd& residuals) {
    const Eigen::Matrix<double, 24, 24> squares = columns * columns.transpose();
    const Eigen::Matrix<double, 24, 1> right = -columns * residuals;
    const auto iu = static_cast<Eigen::Index>(3 * (fu - first));
    const auto iv = static_cast<Eigen::Index>(3 * (fv - first));
    a.block<12, 12>(iu, iu) += squares.block<12, 12>(0, 0);
    a.block<12, 12>(iv, iv) += squares.block<12, 12>(12, 12);
    a.block<12, 12>(iu, iv) += squares.block<12, 12>(0, 12);
    a.block<12, 12>(iv, iu) += squares.block<12, 12>(12, 0);
    b.segment<12>(iu) += right.head<12>();
    b.segment<12>(iv) += right.tail<12>();
  }
};

/// A residual depends on the pose of a sweep by this derivative, and so on the control points of that pose.
struct Dependence {
  const Eigen::Vector3d& by_pose;
  const SweepTrajectory::Support& support;
};

/// Collects equations of the same unknowns, so that they are multiplied out together.
class Collector {
 public:
  explicit Collector(Block& block) : block_(block), columns_(24, kMost), residuals_(kMost) {}
  ~Collector() { flush(); }
  Collector(const Collector&) = delete;
  Collector& operator=(const Collector&) = delete;

  void add(const Dependence& a, const Dependence& b, double root_weight, double residual) {
    if (num_ == kMost || a.support.first != fu_ || b.support.first != fv_) flush();
    fu_ = a.support.first;
    fv_ = b.support.first;
    for (std::size_t k = 0; k < SweepTrajectory::kOrder; ++k) {
      const auto row = static_cast<Eigen::Index>(3 * k);
      columns_.col(num_).segment<3>(row) = (root_weight * a.support.weights[k]) * a.by_pose;
      columns_.col(num_).segment<3>(12 + row) = (root_weight * b.support.weights[k]) * b.by_pose;
    }
    residuals_[num_++] = root_weight * residual;
  }

 private:
  static constexpr Eigen::Index kMost = 64;

  void flush() {
    if (num_ > 0) block_.add(fu_, fv_, columns_.leftCols(num_), residuals_.head(num_));
    num_ = 0;
  }

  Block& block_;
  Eigen::Matrix<double, 24, Eigen::Dynamic> columns_;
  Eigen::VectorXd residuals_;
  Eigen::Index num_ = 0;
  std::size_t fu_ = 0;
  std::size_t fv_ = 0;
};

void add_partners(const Linearised& from, const Linearised& to, double gate_m, std::size_t stride, Block& block) {
  const double trusted_m = kTrustedShareOfGate * gate_m;
  Collector collector(block);
  SweepNeighbours neighbours(to.placed);
  for (std::size_t k = 0; k < from.placed.p_m.size(); k += stride) {
    const Point2& own = from.placed.normals[k];
    if (own.isZero()) continue;
    const PointIndex::Neighbour near = neighbours.nearest(from.placed.p_m[k], gate_m);
    if (!(near.distance_m <= gate_m)) continue;
    const Point2& normal = to.placed.normals[near.point];
    if (normal.isZero() || std::abs(normal.dot(own)) < kCosTangentGate) continue;
    const double residual_m = normal.dot(from.placed.p_m[k] - to.placed.p_m[near.point]);
    const double ratio = residual_m / trusted_m;
    const double root_weight = 1.0 / (kResidual_m * (1.0 + ratio * ratio));
    const Point2& ta = from.turned_m[k];
    const Point2& tb = to.turned_m[near.point];
    const Eigen::Vector3d ja(normal.x(), normal.y(), normal.dot(Point2(-ta.y(), ta.x())));
    const Eigen::Vector3d jb(-normal.x(), -normal.y(), -normal.dot(Point2(-tb.y(), tb.x())));
    collector.add({ja, from.supports[k]}, {jb, to.supports[near.point]}, root_weight, residual_m);
  }
}

class Fit {
 public:
  Fit(const std::vector<TimedSweep>& sweeps, const SweepFitRange& range, const SweepFitOptions& options,
      SweepTrajectory& trajectory)
      : sweeps_(sweeps), first_(range.first), last_(range.last), options_(options), trajectory_(trajectory) {
    begin_ = trajectory.support(sweeps[first_].first_s).first;
    end_ = trajectory.support(sweeps[first_].last_s).first + SweepTrajectory::kOrder;
    for (std::size_t i = first_; i < last_; ++i) {
      begin_ = std::min(begin_, trajectory.support(sweeps[i].first_s).first);
      end_ = std::max(end_, trajectory.support(sweeps[i].last_s).first + SweepTrajectory::kOrder);
    }
    fixed_ = std::min(std::max(range.first_free, begin_), end_) - begin_;
  }

  /// Does one iteration and returns the largest move of a control point along any of x, y and the heading.
  double iterate(double gate_m) {
    std::vector<Linearised> linear(last_ - first_);
    parallel_for(linear.size(), options_.threads,
                 [&](std::size_t i) { linear[i] = linearised(sweeps_[first_ + i], trajectory_); });
    std::vector<Block> blocks(linear.size());
    parallel_for(linear.size(), options_.threads, [&](std::size_t i) { blocks[i] = block_of(i, linear, gate_m); });
    BandedSystem system(3 * (end_ - begin_), bandwidth(blocks));
    for (const Block& block : blocks) system.add(3 * (block.first - begin_), block.a, block.b);
    add_smoothness(system);
    hold(system);
    const Eigen::VectorXd step = system.solve();
    for (std::size_t k = fixed_; k < end_ - begin_; ++k) {
      trajectory_.controls()[begin_ + k] += step.segment<3>(static_cast<Eigen::Index>(3 * k));
    }
    return step.cwiseAbs().maxCoeff();
  }

 private:
  Block block_of(std::size_t i, const std::vector<Linearised>& linear, double gate_m) const {
    const std::size_t beyond = std::min(i + kReach + 1, linear.size());
    Block block;
    block.first = trajectory_.controls().size();
    std::size_t end = 0;
    for (std::size_t j = i; j < beyond; ++j) {
      for (const SweepTrajectory::Support& support : linear[j].supports) {
        block.first = std::min(block.first, support.first);
        end = std::max(end, support.first + SweepTrajectory::kOrder);
      }
    }
    if (end == 0) {
      block.first = begin_;
      return block;
    }
    const auto size = static_cast<Eigen::Index>(3 * (end - block.first));
    block.a = Eigen::MatrixXd::Zero(size, size);
    block.b = Eigen::VectorXd::Zero(size);
    for (std::size_t j = i + 1; j < beyond; ++j) {
      add_partners(linear[i], linear[j], gate_m, options_.stride, block);
      add_partners(linear[j], linear[i], gate_m, options_.stride, block);
    }
    return block;
  }

  static std::size_t bandwidth(const std::vector<Block>& blocks) {
    std::size_t widest = 3 * SweepTrajectory::kOrder;
    for (const Block& block : blocks) widest = std::max(widest, static_cast<std::size_t>(block.a.rows()));
    return widest;
  }

  /// Penalises third differences, including those that reach into the fixed control points.
  void add_smoothness(BandedSystem& system) const {
    const double cube_s3 = std::pow(trajectory_.knot_s(), 3);
    const Eigen::Vector3d sigma(kJerk_m_s3 * cube_s3, kJerk_m_s3 * cube_s3, kJerk_rad_s3 * cube_s3);
    constexpr std::array<double, 4> kDifference{-1.0, 3.0, -3.0, 1.0};
    for (std::size_t k = begin_; k + 3 < end_; ++k) {
      Eigen::Vector3d value = Eigen::Vector3d::Zero();
      for (std::size_t m = 0; m < 4; ++m) value += kDifference[m] * trajectory_.controls()[k + m];
      Eigen::MatrixXd a = Eigen::MatrixXd::Zero(12, 12);
      Eigen::VectorXd b = Eigen::VectorXd::Zero(12);
      for (std::size_t m = 0; m < 4; ++m) {
        for (Eigen::Index d = 0; d < 3; ++d) {
          const double weight = 1.0 / (sigma[d] * sigma[d]);
          const auto row = static_cast<Eigen::Index>(3 * m) + d;
          b[row] -= weight * kDifference[m] * value[d];
          for (std::size_t n = 0; n < 4; ++n) {
            a(row, static_cast<Eigen::Index>(3 * n) + d) += weight * kDifference[m] * kDifference[n];
          }
        }
      }
      system.add(3 * (k - begin_), a, b);
    }
  }

  /// Holds the fixed control points, and all others weakly. Without fixed ones, the first is held.
  void hold(BandedSystem& system) const {
    constexpr double kFixed = 1e12;
    constexpr double kHeld = 1e-3;
    for (std::size_t row = 0; row < 3 * (end_ - begin_); ++row) {
      system.add_to_diagonal(row, row < 3 * std::max<std::size_t>(fixed_, 1) ? kFixed : kHeld);
    }
  }

  const std::vector<TimedSweep>& sweeps_;
  std::size_t first_;
  std::size_t last_;
  const SweepFitOptions& options_;
  SweepTrajectory& trajectory_;
  std::size_t begin_ = 0;  ///< range of control points
  std::size_t end_ = 0;
  std::size_t fixed_ = 0;  ///< so many of these, from the first on, are fixed
};

}  // namespace

void fit_sweeps(const std::vector<TimedSweep>& sweeps, const SweepFitRange& range, const SweepFitOptions& options,
                SweepTrajectory& trajectory) {
  Fit fit(sweeps, range, options, trajectory);
  double gate_m = options.first_gate_m;
  const double shrink = options.iterations > 1 ? std::pow(options.last_gate_m / options.first_gate_m,
                                                          1.0 / static_cast<double>(options.iterations - 1))
                                               : 1.0;
  for (int k = 0; k < options.iterations; ++k, gate_m *= shrink) {
    if (fit.iterate(gate_m) < options.still) break;
  }
}

}  // namespace shapemap
