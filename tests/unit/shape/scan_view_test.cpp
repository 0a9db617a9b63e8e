// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/scan_view.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>
#include <random>

#include "support/matchers.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

using test::IsNearPoint;

TEST(ScanView, HasADirectionAndWeightsForEveryPoint) {
  const ScanView view = test::view_from(test::cluttered_room(1), {});
  ASSERT_GT(view.size(), 100U);
  ASSERT_EQ(view.directions.size(), view.size());
  ASSERT_EQ(view.weights.size(), view.size());
  ASSERT_EQ(view.cross_weights.size(), view.size());
  ASSERT_EQ(view.index.size(), view.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    EXPECT_NEAR(view.directions[i].norm(), 1.0, 1e-12);
    EXPECT_GT(view.weights[i], 0.0);
    EXPECT_TRUE(view.cross_weights[i] >= 0.0 && view.cross_weights[i] <= 1.0 + 1e-12);
    EXPECT_LT(view.index.nearest(view.points[i].p_m).distance_m, 1e-12);
  }
}

TEST(ScanView, HasNoMorePointsThanAskedFor) {
  std::mt19937 rng(1);
  const Scan scan = test::scan_of(test::cluttered_room(1), {}, test::full_circle(), rng);
  for (const int max_points : {20, 100, 240, 5000}) {
    const ScanView view = view_of(scan, {}, {}, {}, {max_points});
    EXPECT_LE(view.size(), static_cast<std::size_t>(max_points));
    EXPECT_GE(view.size(), std::min<std::size_t>(100, static_cast<std::size_t>(max_points) / 3));
  }
}

TEST(ScanView, WeighsTheWallsOfACorridorLessThanItsEnd) {
  test::World world = test::bare_corridor();
  world.push_back({{4.0, -1.2}, {4.0, 1.2}});
  const ScanView view = test::view_from(world, {}, test::half_circle());
  int num_ends = 0;
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (view.points[i].p_m.x() > 3.9 && std::abs(view.points[i].p_m.y()) < 1.0) {
      EXPECT_GT(view.cross_weights[i], 0.9);
      ++num_ends;
    } else if (std::abs(view.points[i].p_m.x()) < 3.5) {
      EXPECT_LT(view.cross_weights[i], 0.1);
    }
  }
  EXPECT_GT(num_ends, 10);
}

TEST(ScanView, TurnsWithItsScan) {
  std::mt19937 rng(1);
  const Scan scan = test::scan_of(test::cluttered_room(1), {}, test::full_circle(), rng);
  const ScanView view = test::view_of(scan);
  const ScanView turned = test::view_of(test::turned(scan, 90 * kDegree));
  ASSERT_EQ(turned.size(), view.size());
  EXPECT_NEAR(turned.reach_m, view.reach_m, 1e-9);
  for (std::size_t i = 0; i < view.size(); ++i) {
    EXPECT_THAT(turned.points[i].p_m, IsNearPoint(rotate(view.points[i].p_m, kPi / 2), 1e-9));
    EXPECT_THAT(turned.directions[i], IsNearPoint(rotate(view.directions[i], kPi / 2), 1e-9));
    EXPECT_NEAR(turned.cross_weights[i], view.cross_weights[i], 1e-6);
  }
}

TEST(ScanView, CountsEveryPointOfTheShapeInItsTangents) {
  std::mt19937 rng(1);
  const Scan scan = test::scan_of(test::cluttered_room(1), {}, test::full_circle(), rng);
  const double sum = [&] {
    const TangentHistogram tangents = test::view_of(scan).tangents;
    return std::accumulate(tangents.begin(), tangents.end(), 0.0);
  }();
  const std::size_t num_points = shapemap::shape_of(scan, {}, {}, {}).size();
  EXPECT_GE(sum, static_cast<double>(num_points)) << "each counts once in its own bin, and less in those beside";
  TangentHistogram before = test::view_of(scan).tangents;
  const TangentHistogram coarser = view_of(scan, {}, {}, {}, {20}).tangents;
  EXPECT_EQ(before, coarser) << "those that are not compared count as well";
}

TEST(ScanView, ReachesAsFarAsNineOfTenReturns) {
  const ScanView view = test::view_from(test::round_room(3.0), {});
  EXPECT_NEAR(view.reach_m, 3.0, 0.05);
}

TEST(ScanView, SeesAShareOfAllDirections) {
  EXPECT_EQ(test::view_from(test::round_room(3.0), {}).seen_share, 1.0);
  EXPECT_NEAR(test::view_from(test::round_room(3.0), {}, test::half_circle()).seen_share, 0.5, 0.03);
}

/// A laser at the front of a robot sees no less for it.
TEST(ScanView, SeesAsMuchWhereverItIsMounted) {
  std::mt19937 rng(1);
  Scan scan = test::scan_of(test::round_room(3.0), {}, test::half_circle(), rng);
  const double here = test::view_of(scan).seen_share;
  for (Sweep& sweep : scan.sweeps) sweep.robot_from_sensor.x_m += 1.5;
  EXPECT_EQ(test::view_of(scan).seen_share, here);
}

TEST(ScanView, OfNoReturnsIsEmpty) {
  for (const Scan& scan : {test::blind_scan(), Scan{}}) {
    const ScanView view = test::view_of(scan);
    EXPECT_EQ(view.size(), 0U);
    EXPECT_EQ(view.reach_m, 0.0);
    EXPECT_EQ(view.seen_share, 0.0);
    EXPECT_EQ(view.images.size(), scan.sweeps.size());
  }
}

}  // namespace
}  // namespace shapemap
