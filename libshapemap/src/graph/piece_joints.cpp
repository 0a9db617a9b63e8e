// SPDX-License-Identifier: GPL-3.0-or-later
#include "piece_joints.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace shapemap {
namespace {

/// Joints say the same when they differ by no more, and a little more for each node that lies between them.
constexpr double kSame_m = 0.40;
constexpr double kSame_rad = 6 * kDegree;
constexpr double kDrift_m = 0.02;
constexpr double kDrift_rad = 0.15 * kDegree;

/// Scans see the same walls: witnesses do not add up without limit.
constexpr double kMostStrength = 20.0;

/// What a joint counts for in the mean, at least; and its direction, against its place: as if the scan were so large.
constexpr double kLeastWeight = 0.1;
constexpr double kSquaredSize_m2 = 4.0;

std::size_t apart(std::size_t i, std::size_t j) { return i < j ? j - i : i - j; }

}  // namespace

PoseConstraint PieceJoints::from_piece(std::size_t f, std::size_t joint) const {
  PoseConstraint constraint = joints_[joint].constraint;
  if (piece_of_node_[constraint.a] == f) return constraint;
  std::swap(constraint.a, constraint.b);
  constraint.a_from_b = inverse(constraint.a_from_b);
  return constraint;
}

bool PieceJoints::agrees(std::size_t f, const Pose2& f_from_g, std::size_t joint, std::size_t seed) const {
  const PoseConstraint c = from_piece(f, joint);
  const PoseConstraint s = from_piece(f, seed);
  const Pose2 expected = inverse(piece_from_node_[c.a]) * f_from_g * piece_from_node_[c.b];
  const Pose2 off = inverse(c.a_from_b) * expected;
  const auto nodes = static_cast<double>(apart(c.a, s.a) + apart(c.b, s.b));
  return off.translation().norm() < kSame_m + kDrift_m * nodes &&
         std::abs(off.theta_rad) < kSame_rad + kDrift_rad * nodes;
}

/// The weighted mean of places and directions (Umeyama 1991).
Pose2 PieceJoints::mean_of(std::size_t f, const std::vector<std::size_t>& joints) const {
  Point2 mean_f = Point2::Zero();
  Point2 mean_g = Point2::Zero();
  double sum = 0.0;
  for (const std::size_t joint : joints) {
    const PoseConstraint c = from_piece(f, joint);
    const double weight = joints_[joint].worth + kLeastWeight;
    mean_f += weight * (piece_from_node_[c.a] * c.a_from_b).translation();
    mean_g += weight * piece_from_node_[c.b].translation();
    sum += weight;
  }
  mean_f /= sum;
  mean_g /= sum;
  double sine = 0.0;
  double cosine = 0.0;
  for (const std::size_t joint : joints) {
    const PoseConstraint c = from_piece(f, joint);
    const double weight = joints_[joint].worth + kLeastWeight;
    const Pose2 there = piece_from_node_[c.a] * c.a_from_b;
    const Point2 p = there.translation() - mean_f;
    const Point2 q = piece_from_node_[c.b].translation() - mean_g;
    const double turn_rad = there.theta_rad - piece_from_node_[c.b].theta_rad;
    sine += weight * (q.x() * p.y() - q.y() * p.x() + kSquaredSize_m2 * std::sin(turn_rad));
    cosine += weight * (q.dot(p) + kSquaredSize_m2 * std::cos(turn_rad));
  }
  const double theta_rad = std::atan2(sine, cosine);
  const Point2 shift = mean_f - rotate(mean_g, theta_rad);
  return {shift.x(), shift.y(), theta_rad};
}

/// As that of a cluster of loops: the best joint of each node, summed over the side that says less.
double PieceJoints::strength(std::size_t f, const std::vector<std::size_t>& joints) const {
  std::map<std::size_t, double> by_f;
  std::map<std::size_t, double> by_g;
  for (const std::size_t joint : joints) {
    const PoseConstraint c = from_piece(f, joint);
    by_f[c.a] = std::max(by_f[c.a], joints_[joint].worth);
    by_g[c.b] = std::max(by_g[c.b], joints_[joint].worth);
  }
  double of_f = 0.0;
  double of_g = 0.0;
  for (const auto& [unused, worth] : by_f) of_f += worth;
  for (const auto& [unused, worth] : by_g) of_g += worth;
  return std::min({of_f, of_g, kMostStrength});
}

std::vector<Way> PieceJoints::ways(std::size_t f, std::vector<std::size_t> between) const {
  std::stable_sort(between.begin(), between.end(),
                   [&](std::size_t i, std::size_t j) { return joints_[i].worth > joints_[j].worth; });
  std::vector<Way> found;
  std::set<std::size_t> used;
  for (const std::size_t seed : between) {
    if (used.count(seed) != 0) continue;
    const PoseConstraint s = from_piece(f, seed);
    Way way;
    way.f_from_g = piece_from_node_[s.a] * s.a_from_b * inverse(piece_from_node_[s.b]);
    for (const std::size_t joint : between) {
      if (agrees(f, way.f_from_g, joint, seed)) way.joints.push_back(joint);
    }
    used.insert(way.joints.begin(), way.joints.end());
    way.f_from_g = mean_of(f, way.joints);
    way.gain = strength(f, way.joints) + joints_[seed].noise;
    found.push_back(std::move(way));
  }
  return found;
}

bool PieceJoints::holds(const Joint& joint) const {
  const PoseConstraint& c = joint.constraint;
  const Pose2 off = inverse(c.a_from_b) * (inverse(piece_from_node_[c.a]) * piece_from_node_[c.b]);
  return off.translation().norm() < kSame_m && std::abs(off.theta_rad) < kSame_rad;
}

std::vector<Crossing> crossings(const std::vector<std::size_t>& of_f, const std::vector<std::size_t>& of_g) {
  std::vector<Crossing> found;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < of_f.size() && j < of_g.size()) {
    const bool f_first = of_f[i] < of_g[j];
    const bool is_last =
        f_first ? i + 1 == of_f.size() || of_f[i + 1] > of_g[j] : j + 1 == of_g.size() || of_g[j + 1] > of_f[i];
    if (is_last) found.push_back({of_f[i], of_g[j], apart(of_f[i], of_g[j])});
    ++(f_first ? i : j);
  }
  return found;
}

}  // namespace shapemap
