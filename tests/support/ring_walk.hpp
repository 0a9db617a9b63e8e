// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <random>
#include <vector>

#include "shapemap/inference/map_search.hpp"
#include "support/random_graph.hpp"
#include "support/views.hpp"

/// A robot walks along a corridor that runs round in a ring, until it is back at the first place.
namespace shapemap::test {

inline constexpr double kRingHalfX_m = 6.0;  // half of the path along its middle
inline constexpr double kRingHalfY_m = 4.0;
inline constexpr double kRingLength_m = 4 * (kRingHalfX_m + kRingHalfY_m);
inline constexpr double kRingStep_m = 0.8;
inline constexpr std::size_t kRingLap = 50;  // in steps

/// Returns the pose at `along_m` from the corner at the lower left, counterclockwise, facing ahead.
inline Pose2 on_ring(double along_m) {
  double left_m = std::fmod(along_m, kRingLength_m);
  Pose2 corner{-kRingHalfX_m, -kRingHalfY_m, 0.0};
  for (int side = 0; side < 4; ++side) {
    const double length_m = 2 * (side % 2 == 0 ? kRingHalfX_m : kRingHalfY_m);
    if (left_m < length_m || side == 3) return corner * Pose2{left_m, 0.0, 0.0};
    left_m -= length_m;
    corner = corner * Pose2{length_m, 0.0, kPi / 2};
  }
  return corner;
}

/// Builds the walls of the corridor, 2.4 m apart, and boxes along them, so that no two places look the same.
inline World ring_world(unsigned seed) {
  World world;
  add_box(world, {}, kRingHalfX_m + 1.2, kRingHalfY_m + 1.2);
  add_box(world, {}, kRingHalfX_m - 1.2, kRingHalfY_m - 1.2);
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  constexpr int kBoxes = 22;
  for (int i = 0; i < kBoxes; ++i) {
    const double along_m = kRingLength_m * (i + 0.8 * unit(rng)) / kBoxes;
    const double beside_m = (unit(rng) < 0.5 ? -1.0 : 1.0) * (0.75 + 0.3 * unit(rng));
    const double half_x_m = 0.10 + 0.3 * unit(rng);
    add_box(world, on_ring(along_m) * Pose2{0.0, beside_m, kPi * unit(rng)}, half_x_m, 0.10 + 0.1 * unit(rng));
  }
  return world;
}

/// The robot sways, and turns its head.
inline std::vector<Pose2> ring_walk(std::size_t count, unsigned seed, double from_m = 0.0) {
  std::mt19937 rng(seed);
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i < count; ++i) {
    poses.push_back(on_ring(from_m + kRingStep_m * static_cast<double>(i)) * random_pose(rng, 0.12, 0.4));
  }
  return poses;
}

using Views = std::vector<std::shared_ptr<const ScanView>>;

inline Views views_along(const World& world, const std::vector<Pose2>& poses, unsigned seed = 1,
                         const Scanner& scanner = full_circle()) {
  Views views;
  for (const Pose2& pose : poses) views.push_back(std::make_shared<ScanView>(view_from(world, pose, scanner, seed++)));
  return views;
}

inline Eigen::Matrix3d covariance_of(double deviation_m, double deviation_rad) {
  const double area = deviation_m * deviation_m;
  return Eigen::Vector3d(area, area, deviation_rad * deviation_rad).asDiagonal();
}

/// Returns the odometry edges of a robot that errs by `drift_rad` to the left at each step.
inline std::vector<Edge> drifting_edges(const std::vector<Pose2>& truth, double drift_rad, unsigned seed = 3) {
  std::mt19937 rng(seed);
  std::vector<Edge> edges(truth.size() - 1);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Pose2 step = inverse(truth[i]) * truth[i + 1] * random_pose(rng, 0.02, 0.1 * kDegree);
    edges[i].candidates = {{i, i + 1, step * Pose2{0.0, 0.0, drift_rad}, covariance_of(0.03, 1 * kDegree), 0.0}};
    edges[i].probability = 0.99;
  }
  return edges;
}

/// The runs are the nodes a, a + 1, ... and b, b + 1, ..., so many of each.
struct NodeRuns {
  std::size_t a;
  std::size_t b;
  std::size_t count;
};

/// Closes a loop between two runs of nodes, at poses that `wrong` moves from `truth`.
inline LoopCluster cluster_of(const std::vector<Pose2>& truth, const NodeRuns& runs, double strength,
                              const Pose2& wrong = {}) {
  const auto [a, b, count] = runs;
  std::mt19937 rng(4);
  LoopCluster cluster;
  for (std::size_t k = 0; k < count; ++k) {
    const Pose2 a_from_b = inverse(truth[a + k]) * wrong * truth[b + k] * random_pose(rng, 0.02, 0.3 * kDegree);
    cluster.members.push_back(
        {a + k, b + k, a_from_b, covariance_of(0.05, 1 * kDegree), 3.0 - 0.1 * static_cast<double>(k)});
  }
  cluster.strength = strength;
  cluster.num_a = cluster.num_b = count;
  return cluster;
}

/// Returns the largest distance of a node from its true place, when both maps have node `first` at the same place.
inline double worst_off_m(const std::vector<Pose2>& map_from_node, const std::vector<Pose2>& truth, std::size_t first,
                          std::size_t last) {
  const Pose2 truth_from_map = truth[first] * inverse(map_from_node[first]);
  double worst_m = 0.0;
  for (std::size_t n = first; n < last; ++n) {
    worst_m = std::max(worst_m, (truth_from_map * map_from_node[n].translation() - truth[n].translation()).norm());
  }
  return worst_m;
}

inline double worst_off_m(const std::vector<Pose2>& map_from_node, const std::vector<Pose2>& truth) {
  return worst_off_m(map_from_node, truth, 0, truth.size());
}

/// Composes the first candidates of `edges`.
inline std::vector<Pose2> dead_reckoning(const std::vector<Edge>& edges, const Pose2& first = {}) {
  std::vector<Pose2> poses{first};
  for (const Edge& edge : edges) poses.push_back(poses.back() * edge.candidates.front().a_from_b);
  return poses;
}

}  // namespace shapemap::test
