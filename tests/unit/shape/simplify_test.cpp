// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/simplify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "shapemap/shape/polyline_em.hpp"

namespace shapemap {
namespace {

using Indices = std::vector<std::size_t>;

/// Every answer must have ascending indices of given points, from the first to the last distinct one.
void expect_well_formed(const std::vector<Point2>& points, const Indices& kept) {
  ASSERT_FALSE(kept.empty());
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(std::adjacent_find(kept.begin(), kept.end()), kept.end());
  ASSERT_LT(kept.back(), points.size());
  EXPECT_EQ(points[kept.front()], points.front());
  EXPECT_EQ(points[kept.back()], points.back());
}

/// Returns the largest distance of a point from the stretch of the simple polyline that replaces it.
double largest_distance_m(const std::vector<Point2>& points, const Indices& kept) {
  double largest_m = 0.0;
  for (std::size_t v = 0; v + 1 < kept.size(); ++v) {
    const LineSegment stretch{points[kept[v]], points[kept[v + 1]]};
    for (std::size_t i = kept[v]; i <= kept[v + 1]; ++i) {
      largest_m = std::max(largest_m, stretch.distance_m(points[i]));
    }
  }
  return largest_m;
}

TEST(SimplifyPolyline, OfNothingIsNothing) { EXPECT_TRUE(simplify_polyline({}, 0.05).empty()); }

TEST(SimplifyPolyline, OfOneOrTwoPointsIsThePoints) {
  EXPECT_EQ(simplify_polyline({{1.0, 2.0}}, 0.05), Indices{0});
  EXPECT_EQ(simplify_polyline({{1.0, 2.0}, {1.0, 2.001}}, 0.05), (Indices{0, 1}));
}

TEST(SimplifyPolyline, CollapsesAStraightLineToItsEnds) {
  std::vector<Point2> points;
  for (int i = 0; i <= 40; ++i) points.emplace_back(0.1 * i, 0.05 * i);
  EXPECT_EQ(simplify_polyline(points, 0.01), (Indices{0, 40}));
}

TEST(SimplifyPolyline, KeepsACorner) {
  std::vector<Point2> points;
  for (int i = 0; i <= 20; ++i) points.emplace_back(0.1 * i, 0.0);
  for (int i = 1; i <= 20; ++i) points.emplace_back(2.0, 0.1 * i);
  EXPECT_EQ(simplify_polyline(points, 0.05), (Indices{0, 20, 40}));
}

TEST(SimplifyPolyline, KeepsASpikeThatIsHigherThanTheTolerance) {
  const std::vector<Point2> points{{0.0, 0.0}, {1.0, 0.0}, {1.5, 0.6}, {2.0, 0.0}, {3.0, 0.0}};
  const Indices kept = simplify_polyline(points, 0.05);
  EXPECT_TRUE(std::find(kept.begin(), kept.end(), 2U) != kept.end());
}

TEST(SimplifyPolyline, DropsASpikeThatIsLowerThanTheTolerance) {
  const std::vector<Point2> points{{0.0, 0.0}, {1.0, 0.0}, {1.5, 0.02}, {2.0, 0.0}, {3.0, 0.0}};
  EXPECT_EQ(simplify_polyline(points, 0.05), (Indices{0, 4}));
}

TEST(SimplifyPolyline, PassesOverRepeatedPoints) {
  const std::vector<Point2> points{{0, 0}, {0, 0}, {1, 0}, {1, 0}, {1, 0}, {1, 1}, {1, 1}};
  const Indices kept = simplify_polyline(points, 0.05);
  expect_well_formed(points, kept);
  EXPECT_EQ(kept.size(), 3U);
}

TEST(SimplifyPolyline, OfOnePlaceManyTimesIsOnePoint) {
  EXPECT_EQ(simplify_polyline(std::vector<Point2>(9, Point2(3.0, 4.0)), 0.05).size(), 1U);
}

TEST(SimplifyPolyline, TakesALineThatCrossesItself) {
  const std::vector<Point2> points{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, -1}, {0, -1}};
  const Indices kept = simplify_polyline(points, 0.05);
  expect_well_formed(points, kept);
  EXPECT_EQ(kept.size(), points.size());
}

TEST(SimplifyPolyline, TakesALineThatRunsBackOverItself) {
  const std::vector<Point2> points{{0, 0}, {1, 0}, {2, 0}, {1, 0}, {0, 0.5}};
  expect_well_formed(points, simplify_polyline(points, 0.05));
}

TEST(SimplifyPolyline, TakesALineThatRunsOverOneOfItsVerticesTwice) {
  const std::vector<Point2> points{{4, 3}, {3, 3}, {4, 2}, {2, 5}, {6, 1}, {6, 2}, {6, 1}, {6, 4}};
  expect_well_formed(points, simplify_polyline(points, 0.5));
}

TEST(SimplifyPolyline, TakesALoopThatEndsWhereItBegan) {
  std::vector<Point2> points;
  for (int i = 0; i <= 36; ++i) points.push_back(rotate({2.0, 0.0}, (i % 36) * 10 * kDegree));
  const Indices kept = simplify_polyline(points, 0.05);
  expect_well_formed(points, kept);
  EXPECT_GE(kept.size(), 4U);
  EXPECT_LE(largest_distance_m(points, kept), 2 * 0.05);
}

TEST(SimplifyPolyline, KeepsDroppedPointsNearTheLineOnRandomSurfaces) {
  // The steps always advance, so that lines do not cross themselves and the cost is the distance.
  constexpr double kTolerance_m = 0.05;
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 rng(seed);
    std::normal_distribution<double> noise(0.0, 0.02);
    std::vector<Point2> points;
    double slope = 0.0;
    Point2 p(0.0, 0.0);
    for (int i = 0; i < 200; ++i) {
      if (i % 40 == 0) slope = std::uniform_real_distribution<double>(-2.0, 2.0)(rng);
      p += Point2(0.05, 0.05 * slope);
      points.emplace_back(p.x(), p.y() + noise(rng));
    }
    const Indices kept = simplify_polyline(points, kTolerance_m);
    expect_well_formed(points, kept);
    ASSERT_LE(largest_distance_m(points, kept), kTolerance_m * (1 + 1e-9)) << seed;
    ASSERT_LT(kept.size(), points.size() / 2) << seed;
  }
}

TEST(SimplifyPolyline, ToleratesAnyScribble) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 rng(seed);
    std::uniform_int_distribution<int> cell(0, 6);  // on a coarse lattice, crossings, repeats and overlaps abound
    std::vector<Point2> points;
    for (int i = 0; i < 30; ++i) points.emplace_back(0.1 * cell(rng), 0.1 * cell(rng));
    expect_well_formed(points, simplify_polyline(points, 0.05));
    if (HasFailure()) FAIL() << "seed " << seed;
  }
}

TEST(SimplifyPolyline, LeavesOutPointsThatAreNoPlaces) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<Point2> points{{kNan, 0.0}, {0.0, 0.0},         {1.0, kInfinity},
                                   {1.0, 1.0},  {-kInfinity, kNan}, {2.0, 0.0}};
  EXPECT_EQ(simplify_polyline(points, 0.05), (std::vector<std::size_t>{1, 3, 5}));
  EXPECT_TRUE(simplify_polyline({{kNan, kNan}, {kNan, 1.0}}, 0.05).empty());
}

}  // namespace
}  // namespace shapemap
