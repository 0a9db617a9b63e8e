// SPDX-License-Identifier: GPL-3.0-or-later
#include "motions.hpp"

#include <cmath>
#include <optional>

#include "shapemap/core/errors.hpp"
#include "shapemap/io/trajectory_files.hpp"

namespace shapemap::baselines {
namespace {

/// TUM lines have nine digits after the point, motions all that a double holds.
constexpr double kSameTime_s = 1e-6;

Eigen::Matrix3d covariance_of(double sigma_m, double sigma_rad) {
  return Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal();
}

/// Finds, for each scan, the line with its time, or null. Both are in the order of the log; a log may repeat a time.
template <class Timed>
std::vector<const Timed*> by_scan(const Log& log, const std::vector<Timed>& lines) {
  std::vector<const Timed*> found(log.scans.size(), nullptr);
  std::size_t at = 0;
  for (const Timed& line : lines) {
    while (at < found.size() && std::abs(log.scans[at].timestamp_s - line.timestamp_s) > kSameTime_s) ++at;
    if (at == found.size()) {
      throw InputError(line.where + ": no position of the log has this timestamp after those of the lines before");
    }
    found[at++] = &line;
  }
  for (std::size_t i = 1; i < found.size(); ++i) {
    const bool same_time = log.scans[i].timestamp_s - log.scans[i - 1].timestamp_s == 0.0;
    if (!same_time || (found[i] == nullptr) == (found[i - 1] == nullptr)) continue;
    const Timed& line = found[i] ? *found[i] : *found[i - 1];
    throw InputError(line.where + ": the log repeats this timestamp, and not all of its positions have a line");
  }
  return found;
}

/// The motion to each scan of the log; nothing where none is known.
using KnownMotions = std::vector<std::optional<Motion>>;

KnownMotions from_poses(const Log& log, const std::string& path, const MotionOptions& options) {
  const std::vector<TimedPose> poses = read_tum_trajectory(path);
  KnownMotions motions(log.scans.size());
  const std::vector<const TimedPose*> found = by_scan(log, poses);
  const TimedPose* last = nullptr;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) continue;
    if (last) {
      motions[i] = Motion{inverse(last->map_from_robot) * found[i]->map_from_robot,
                          covariance_of(options.given_sigma_m, options.given_sigma_rad)};
    }
    last = found[i];
  }
  return motions;
}

void add_covariances(const Log& log, const MotionSources& sources, KnownMotions& motions) {
  const std::vector<TimedMotion> lines = read_motions(sources.covariances_path);
  const std::vector<const TimedMotion*> found = by_scan(log, lines);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i] || found[i] == &lines.front()) continue;  // the first one has no motion
    if (sources.poses_path.empty()) motions[i] = Motion{found[i]->previous_from_this, found[i]->covariance};
    if (motions[i]) motions[i]->covariance = found[i]->covariance;
  }
}

}  // namespace

Motion compose(const Motion& first, const Motion& second) {
  const Pose2& a = first.previous_from_this;
  const Point2 moved = rotate(second.previous_from_this.translation(), a.theta_rad);
  Eigen::Matrix3d by_first = Eigen::Matrix3d::Identity();
  by_first(0, 2) = -moved.y();
  by_first(1, 2) = moved.x();
  Eigen::Matrix3d by_second = Eigen::Matrix3d::Identity();
  by_second.topLeftCorner<2, 2>() << std::cos(a.theta_rad), -std::sin(a.theta_rad), std::sin(a.theta_rad),
      std::cos(a.theta_rad);
  return {a * second.previous_from_this,
          by_first * first.covariance * by_first.transpose() + by_second * second.covariance * by_second.transpose()};
}

std::vector<Motion> motions_for(const Log& log, const SelectionOptions& selection, const MotionSources& sources,
                                const MotionOptions& options) {
  validate(options);
  KnownMotions known(log.scans.size());
  if (!sources.poses_path.empty()) known = from_poses(log, sources.poses_path, options);
  if (!sources.covariances_path.empty()) add_covariances(log, sources, known);

  const Motion nothing_known{Pose2{}, covariance_of(options.unknown_sigma_m, options.unknown_sigma_rad)};
  std::vector<Motion> motions;
  std::optional<Motion> way;  // motion since the last selected scan
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    if (known[i]) way = way ? compose(*way, *known[i]) : *known[i];
    if (i != index_in_whole_log(motions.size(), selection)) continue;
    if (selection.first > 0 && motions.size() == static_cast<std::size_t>(selection.first)) break;
    motions.push_back(way.value_or(nothing_known));
    way.reset();
  }
  return motions;
}

}  // namespace shapemap::baselines
