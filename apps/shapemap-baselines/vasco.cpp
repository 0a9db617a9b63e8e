// SPDX-License-Identifier: GPL-3.0-or-later
#include "vasco.hpp"

#include <Eigen/LU>
#include <cmath>

#include "hill_climbing.hpp"
#include "local_map.hpp"

namespace shapemap::baselines {
namespace {

/// The log probability of a pose before the scan counts, up to a constant.
class MotionPrior {
 public:
  MotionPrior(const Pose2& map_from_previous, const Motion& motion)
      : previous_from_map_(inverse(map_from_previous)), mean_(motion.previous_from_this) {
    // A hundredth of a millimetre keeps certain motions invertible.
    information_ = (motion.covariance + 1e-10 * Eigen::Matrix3d::Identity()).inverse();
  }

  double operator()(const Pose2& map_from_robot) const {
    const Pose2 moved = previous_from_map_ * map_from_robot;
    const Eigen::Vector3d off(moved.x_m - mean_.x_m, moved.y_m - mean_.y_m,
                              wrap_angle(moved.theta_rad - mean_.theta_rad));
    return -0.5 * off.dot(information_ * off);
  }

 private:
  Pose2 previous_from_map_;
  Pose2 mean_;
  Eigen::Matrix3d information_;
};

class Vasco : public SlamMethod {
 public:
  Vasco(const VascoOptions& options, const ReturnOptions& returns)
      : options_(options), returns_(returns), map_(static_cast<std::size_t>(options.local_scans), options.cell_m) {
    validate(options);
  }

  void add(const Scan& scan, const Motion& motion) override {
    const std::vector<Beam> beams = beams_of(scan, returns_, options_.longest_beam_m);
    Pose2 pose;
    if (!poses_.empty()) {
      pose = poses_.back() * motion.previous_from_this;
      if (!beams.empty()) pose = most_likely(pose, MotionPrior(poses_.back(), motion), beams);
    }
    map_.add(pose, beams);
    poses_.push_back(pose);
  }

  std::vector<Pose2> map_from_robot() const override { return poses_; }

 private:
  Pose2 most_likely(Pose2 pose, const MotionPrior& prior, const std::vector<Beam>& beams) const {
    const std::vector<OccupiedSpot> spots = map_.occupied_spots(pose.translation(), options_.longest_beam_m);
    if (spots.empty()) return pose;
    for (int level = options_.levels - 1; level >= 0; --level) {
      const LikelihoodField field(spots, std::ldexp(options_.finest_sigma_m, level));
      const auto score = [&](const Pose2& candidate) {
        return prior(candidate) + log_likelihood(field, candidate, beams);
      };
      pose = climb(pose, score, {field.sigma_m(), field.sigma_m() / options_.lever_m, options_.halvings});
    }
    return pose;
  }

  double log_likelihood(const LikelihoodField& field, const Pose2& pose, const std::vector<Beam>& beams) const {
    const Turn turn(pose.theta_rad);
    double sum = 0.0;
    for (const Beam& beam : beams) {
      sum += std::log(options_.floor + (1.0 - options_.floor) * field.at(turn * beam.to_m + pose.translation()));
    }
    return sum;
  }

  VascoOptions options_;
  ReturnOptions returns_;
  LocalMap map_;
  std::vector<Pose2> poses_;
};

}  // namespace

std::unique_ptr<SlamMethod> make_vasco(const VascoOptions& options, const ReturnOptions& returns) {
  return std::make_unique<Vasco>(options, returns);
}

}  // namespace shapemap::baselines
