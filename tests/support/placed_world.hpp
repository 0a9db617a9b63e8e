// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>
#include <vector>

#include "shapemap/mapper/map_result.hpp"
#include "support/synthetic_world.hpp"

/// A simulated log comes with its true poses.
namespace shapemap::test {

struct PlacedLog {
  Log log;
  std::vector<PlacedScan> placed;

  void add(Scan scan, const Pose2& map_from_robot) {
    scan.timestamp_s = static_cast<double>(placed.size());
    placed.push_back({placed.size(), scan.timestamp_s, map_from_robot, std::vector<Pose2>(scan.sweeps.size())});
    log.scans.push_back(std::move(scan));
  }
};

/// A leg is a straight walk of evenly spaced scans, all with the heading of `first`.
struct Leg {
  Pose2 first;
  Point2 last_m;
  int num_scans = 2;
};

inline void add_walk(PlacedLog& walk, const World& world, const Leg& leg, const Scanner& scanner, std::mt19937& rng) {
  for (int i = 0; i < leg.num_scans; ++i) {
    const double share = leg.num_scans > 1 ? static_cast<double>(i) / (leg.num_scans - 1) : 0.0;
    const Point2 at_m = leg.first.translation() + share * (leg.last_m - leg.first.translation());
    const Pose2 pose{at_m.x(), at_m.y(), leg.first.theta_rad};
    walk.add(scan_of(world, pose, scanner, rng), pose);
  }
}

inline PlacedLog walk_through(const World& world, const Leg& leg, const Scanner& scanner = {}, unsigned seed = 1) {
  PlacedLog walk;
  std::mt19937 rng(seed);
  add_walk(walk, world, leg, scanner, rng);
  return walk;
}

}  // namespace shapemap::test
