// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/io/trajectory_files.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "references.hpp"
#include "shapemap/core/errors.hpp"
#include "text.hpp"

namespace shapemap {
namespace {

constexpr std::array<const char*, 8> kTumNames{"the timestamp", "x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::array<const char*, 10> kMotionNames{
    "the timestamp", "x_m", "y_m", "theta_rad", "xx", "xy", "xt", "yy", "yt", "tt"};

/// The variances of a motion that no match constrains, only the rest of the map, are 1 m and 1 rad squared.
const Eigen::Vector3d kUnheld = Eigen::Vector3d::Ones();

/// Calls `take(lines, values)` for each line that holds more than a remark.
template <std::size_t kCount, class Take>
void read_rows(const std::string& path, const std::array<const char*, kCount>& names, const char* expected,
               const Take& take) {
  ByteSource source(path);
  LineReader lines(source);
  while (const std::optional<std::string_view> line = lines.next()) {
    Words words(line->substr(0, line->find('#')));
    const std::size_t count = words.count_left();
    if (count == 0) continue;
    if (count != kCount) {
      throw lines.error(std::string("expected ") + expected + ", found " + std::to_string(count) + " values");
    }
    std::array<double, kCount> values{};
    for (std::size_t i = 0; i < kCount; ++i) values[i] = lines.finite(words.next(), names[i]);
    take(lines, values);
  }
  if (!source.cut().empty()) throw InputError(path + ": " + source.cut());
}

/// Rounding may leave an eigenvalue a little below zero.
bool is_covariance(const Eigen::Matrix3d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(matrix, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& values = eigen.eigenvalues();
  return values.allFinite() && values.minCoeff() >= -1e-9 * std::max(1e-9, values.maxCoeff());
}

/// Returns the covariance of the motion to `scan` from the placed scan before it. Either `scan` is matched with that
/// one, or with the same keyframe as its `sibling`, and then the errors of both matches add up.
Eigen::Matrix3d covariance_of(const Pose2& motion, const ScanResult& scan, const ScanResult* sibling) {
  const ScanMatch& match = scan.match;
  if (!match.covariance.allFinite()) {
    if (scan.has_pose()) {
      throw ConfigError("motions need covariances, which only the robust method gives; use --method robust");
    }
    return kUnheld.asDiagonal();
  }
  if (!sibling || sibling->match.ranked.empty()) return match.covariance;
  const Eigen::Rotation2Dd turn(-sibling->match.ranked.front().ref_from_query.theta_rad);
  Eigen::Matrix3d by_scan = Eigen::Matrix3d::Identity();
  by_scan.topLeftCorner<2, 2>() = turn.toRotationMatrix();
  Eigen::Matrix3d by_sibling = -by_scan;
  by_sibling.topRightCorner<2, 1>() = Eigen::Vector2d(motion.y_m, -motion.x_m);
  const Eigen::Matrix3d sum = by_scan * match.covariance * by_scan.transpose() +
                              by_sibling * sibling->match.covariance * by_sibling.transpose();
  return 0.5 * (sum + sum.transpose());
}

}  // namespace

std::vector<TimedPose> read_tum_trajectory(const std::string& path) {
  std::vector<TimedPose> poses;
  read_rows(path, kTumNames, "'t x y z qx qy qz qw'", [&](const LineReader& lines, const std::array<double, 8>& v) {
    const double norm = v[4] * v[4] + v[5] * v[5] + v[6] * v[6] + v[7] * v[7];
    if (std::abs(norm - 1.0) > 0.01) throw lines.error("qx qy qz qw is no turn: its length is not 1");
    const double theta_rad = std::atan2(2 * (v[7] * v[6] + v[4] * v[5]), norm - 2 * (v[5] * v[5] + v[6] * v[6]));
    poses.push_back({v[0], {v[1], v[2], theta_rad}, lines.where()});
  });
  if (poses.empty()) throw InputError(path + ": holds no pose, expected lines 't x y z qx qy qz qw'");
  return poses;
}

std::vector<TimedMotion> motions_of(const MapResult& result) { return motions_of(result, result.placed()); }

std::vector<TimedMotion> motions_of(const MapResult& result, const std::vector<PlacedScan>& placed) {
  const std::vector<std::size_t> references = references_of(result);
  std::vector<TimedMotion> motions;
  if (!placed.empty()) motions.push_back({placed[0].timestamp_s, {}, Eigen::Matrix3d::Zero(), ""});
  for (std::size_t i = 1; i < placed.size(); ++i) {
    const Pose2 motion = inverse(placed[i - 1].map_from_robot) * placed[i].map_from_robot;
    const std::size_t before = placed[i - 1].scan_index;
    const std::size_t here = placed[i].scan_index;
    const bool share_keyframe = references.at(here) == references.at(before) && references[here] != kNoReference;
    const ScanResult* sibling = share_keyframe ? &result.scans[before] : nullptr;
    motions.push_back({placed[i].timestamp_s, motion, covariance_of(motion, result.scans[here], sibling), ""});
  }
  return motions;
}

std::string motion_lines(const std::vector<TimedMotion>& motions) {
  std::string text = "# timestamp_s x_m y_m theta_rad xx xy xt yy yt tt\n";
  for (const TimedMotion& motion : motions) {
    const Pose2& pose = motion.previous_from_this;
    const Eigen::Matrix3d& c = motion.covariance;
    append_number(text, motion.timestamp_s);
    for (const double value :
         {pose.x_m, pose.y_m, pose.theta_rad, c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)}) {
      text += ' ';
      append_number(text, value);
    }
    text += '\n';
  }
  return text;
}

std::vector<TimedMotion> read_motions(const std::string& path) {
  std::vector<TimedMotion> motions;
  read_rows(path, kMotionNames, "'timestamp_s x_m y_m theta_rad xx xy xt yy yt tt'",
            [&](const LineReader& lines, const std::array<double, 10>& v) {
              TimedMotion motion{v[0], {v[1], v[2], wrap_angle(v[3])}, Eigen::Matrix3d::Zero(), lines.where()};
              motion.covariance << v[4], v[5], v[6], v[5], v[7], v[8], v[6], v[8], v[9];
              if (!is_covariance(motion.covariance)) throw lines.error("xx xy xt yy yt tt is no covariance");
              motions.push_back(std::move(motion));
            });
  if (motions.empty()) throw InputError(path + ": holds no motion, expected lines of 10 numbers");
  return motions;
}

}  // namespace shapemap
