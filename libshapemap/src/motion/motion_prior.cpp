// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/motion/motion_prior.hpp"

#include <algorithm>
#include <cmath>

namespace shapemap {
namespace {

constexpr double kStepBin_m = 0.05;
constexpr std::size_t kStepBins = 200;  // longer steps are as unusual as the longest
constexpr std::size_t kAngleBins = 180;
constexpr double kAngleBin_rad = 2.0 * kPi / static_cast<double>(kAngleBins);

/// The kernels of known motions and of the motion in question deviate by at least this much.
constexpr double kStepKernel_m = 0.25;  ///< kernel of long steps
constexpr double kAngleKernel_rad = 12 * kDegree;

/// The kernel of short steps is half of the usual step, if so many steps tell it, and at least this.
constexpr std::size_t kTellOfSteps = 20;
constexpr double kLeastStepKernel_m = 0.05;

/// The direction of a step counts the more, the longer the step is, up to this length.
constexpr double kHasDirection_m = 0.5;

/// The share of motions of a kind that was never seen falls as kinds grow like the root of the number of motions (the
/// law of Heaps, 1978), and no further than this.
constexpr double kLeastUnheard = 0.03;
double share_of_unheard(std::size_t num_known) {
  return num_known == 0 ? 1.0 : std::max(kLeastUnheard, 0.5 / std::sqrt(static_cast<double>(num_known)));
}

std::size_t step_bin(double step_m) {
  return std::min(static_cast<std::size_t>(std::min(step_m, 1e3) / kStepBin_m), kStepBins - 1);
}

std::size_t angle_bin(double angle_rad) {
  const double turns = angle_rad / (2.0 * kPi);
  const auto bin = static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(kAngleBins));
  return std::min(bin, kAngleBins - 1);
}

double direction_of(const Pose2& motion) { return std::atan2(motion.y_m, motion.x_m); }

double weight_of_direction(const Pose2& motion) { return std::min(1.0, motion.translation().norm() / kHasDirection_m); }

double gaussian(double deviations) { return std::exp(-0.5 * deviations * deviations); }

/// Scales a density to that of its densest bin; an empty one becomes 1 everywhere.
std::vector<double> relative(std::vector<double> density) {
  const double most = *std::max_element(density.begin(), density.end());
  for (double& value : density) value = most > 0.0 ? value / most : 1.0;
  return density;
}

/// Chooses the width of a kernel by the rule of Silverman (1986): it grows as values become fewer and more spread. The
/// middle half counts too, because most robots turn seldom.
double kernel(std::vector<double> values, double least) {
  if (values.size() < 2) return least;
  const auto count = static_cast<double>(values.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const double deviation = std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
  std::sort(values.begin(), values.end());
  const double middle_half = values[values.size() * 3 / 4] - values[values.size() / 4];
  return std::max(least, 0.9 * std::min(deviation, middle_half / 1.34) * std::pow(count, -0.2));
}

double least_step_kernel_m(std::vector<double> steps_m) {
  if (steps_m.size() < kTellOfSteps) return kStepKernel_m;
  std::sort(steps_m.begin(), steps_m.end());
  return std::clamp(0.5 * steps_m[steps_m.size() / 2], kLeastStepKernel_m, kStepKernel_m);
}

/// Computes the density of step lengths; mass below 0 is mirrored there.
std::vector<double> density_of_steps(const std::vector<Pose2>& motions) {
  std::vector<double> steps_m;
  for (const Pose2& motion : motions) steps_m.push_back(motion.translation().norm());
  const double kernel_m = kernel(steps_m, least_step_kernel_m(steps_m));
  std::vector<double> density(kStepBins, 0.0);
  for (const double step_m : steps_m) {
    for (std::size_t k = 0; k < kStepBins; ++k) {
      const double here_m = (static_cast<double>(k) + 0.5) * kStepBin_m;
      density[k] += gaussian((here_m - step_m) / kernel_m) + gaussian((here_m + step_m) / kernel_m);
    }
  }
  return relative(std::move(density));
}

struct WeightedAngle {
  double angle_rad;
  double weight;
};

/// Computes the density of angles on the circle.
std::vector<double> density_of_angles(const std::vector<WeightedAngle>& angles) {
  Point2 mean = Point2::Zero();
  for (const WeightedAngle& one : angles) mean += one.weight * rotate({1.0, 0.0}, one.angle_rad);
  const double middle_rad = std::atan2(mean.y(), mean.x());
  std::vector<double> off_rad;
  for (const WeightedAngle& one : angles) {
    if (one.weight > 0.5) off_rad.push_back(wrap_angle(one.angle_rad - middle_rad));
  }
  const double kernel_rad = kernel(std::move(off_rad), kAngleKernel_rad);
  std::vector<double> density(kAngleBins, 0.0);
  for (const WeightedAngle& one : angles) {
    for (std::size_t k = 0; k < kAngleBins; ++k) {
      const double here_rad = (static_cast<double>(k) + 0.5) * kAngleBin_rad;
      density[k] += one.weight * gaussian(angle_between(here_rad, one.angle_rad) / kernel_rad);
    }
  }
  return relative(std::move(density));
}

}  // namespace

MotionPrior::MotionPrior(const std::vector<Pose2>& known_motions)
    : share_of_unheard_(share_of_unheard(known_motions.size())), by_step_(density_of_steps(known_motions)) {
  std::vector<WeightedAngle> directions;
  std::vector<WeightedAngle> turns;
  for (const Pose2& motion : known_motions) {
    directions.push_back({direction_of(motion), weight_of_direction(motion)});
    turns.push_back({motion.theta_rad, 1.0});
  }
  by_direction_ = density_of_angles(directions);
  by_turn_ = density_of_angles(turns);
}

double MotionPrior::surprise(const Pose2& a_from_b) const {
  const auto cost = [&](double density) { return -std::log(share_of_unheard_ + (1.0 - share_of_unheard_) * density); };
  return cost(by_step_[step_bin(a_from_b.translation().norm())]) + cost(by_turn_[angle_bin(a_from_b.theta_rad)]) +
         weight_of_direction(a_from_b) * cost(by_direction_[angle_bin(direction_of(a_from_b))]);
}

}  // namespace shapemap
