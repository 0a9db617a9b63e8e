// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/polyline_em.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>

#include "support/matchers.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

using test::IsNearAngle;
using test::IsNearPoint;

constexpr double kBeamSpacing_m = 0.01;

PolylineOptions options_for_test() { return test::paper_options().polylines; }

/// Adds points along a wall, both ends included, with noise across and along.
void add_wall(std::vector<ScanPoint>& points, const test::Wall& wall, int count, double noise_m, std::mt19937& rng) {
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int i = 0; i < count; ++i) {
    const Point2 p = wall.start_m + (wall.end_m - wall.start_m) * i / std::max(count - 1, 1);
    points.push_back({p + noise_m * Point2(noise(rng), noise(rng)), kBeamSpacing_m});
  }
}

std::vector<ScanPoint> one_wall(const Point2& from_m, const Point2& to_m, int count) {
  std::mt19937 rng(1);
  std::vector<ScanPoint> points;
  add_wall(points, {from_m, to_m}, count, 0.0, rng);
  return points;
}

TEST(LineSegment, DistanceIsToItsEndsBeyondThem) {
  const LineSegment segment{{1.0, 1.0}, {3.0, 1.0}};
  EXPECT_DOUBLE_EQ(segment.distance_m({2.0, 1.5}), 0.5);
  EXPECT_DOUBLE_EQ(segment.distance_m({6.0, 5.0}), 5.0);
  EXPECT_DOUBLE_EQ(segment.distance_m({1.0, -1.0}), 2.0);
  EXPECT_DOUBLE_EQ((LineSegment{{1.0, 1.0}, {1.0, 1.0}}.distance_m({4.0, 5.0})), 5.0);
}

TEST(SurfaceRuns, BreakWhereNeighboursAreFartherApartThanTheGap) {
  PolylineOptions options;
  options.run_gap_m = 0.20;
  options.run_gap_beams = 5.0;  // and 5 times 1 cm make 0.25 m
  std::vector<ScanPoint> points;
  for (const double x_m : {0.0, 0.1, 0.2, 0.44, 0.70, 0.80}) points.push_back({{x_m, 0.0}, kBeamSpacing_m});
  const auto runs = surface_runs(points, options);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0], (std::pair<std::size_t, std::size_t>(0, 4)));
  EXPECT_EQ(runs[1], (std::pair<std::size_t, std::size_t>(4, 6)));
}

TEST(SurfaceRuns, ThereIsNoneOfASinglePoint) {
  EXPECT_TRUE(surface_runs({}, options_for_test()).empty());
  EXPECT_TRUE(surface_runs({{{1.0, 1.0}, 0.01}}, options_for_test()).empty());
  EXPECT_TRUE(surface_runs({{{1.0, 1.0}, 0.01}, {{9.0, 1.0}, 0.01}}, options_for_test()).empty());
}

TEST(FitPolylines, TwoNoisyWallsWithACornerAreTwoSegments) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 rng(seed);
    std::vector<ScanPoint> points;
    add_wall(points, {{2.0, -2.0}, {2.0, 1.0}}, 150, 0.005, rng);
    add_wall(points, {{1.98, 1.0}, {-1.0, 1.0}}, 150, 0.005, rng);
    const PolylineFit fit = fit_polylines(points, options_for_test());
    ASSERT_EQ(fit.segments.size(), 2U) << seed;
    EXPECT_THAT(fit.segments[0].tangent_rad(), IsNearAngle(90 * kDegree, 1 * kDegree)) << seed;
    EXPECT_THAT(fit.segments[1].tangent_rad(), IsNearAngle(180 * kDegree, 1 * kDegree)) << seed;
    EXPECT_THAT(fit.segments[0].start_m, IsNearPoint(Point2(2.0, -2.0), 0.05));
    EXPECT_THAT(fit.segments[0].end_m, IsNearPoint(Point2(2.0, 1.0), 0.07));
    EXPECT_THAT(fit.segments[1].end_m, IsNearPoint(Point2(-1.0, 1.0), 0.05));
  }
}

TEST(FitPolylines, StrongNoiseLeavesTheWallsTheirDirectionsAndAddsOnlySlivers) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 rng(seed);
    std::vector<ScanPoint> points;
    add_wall(points, {{2.0, -2.0}, {2.0, 1.0}}, 150, 0.01, rng);
    add_wall(points, {{1.98, 1.0}, {-1.0, 1.0}}, 150, 0.01, rng);
    int num_walls = 0;
    for (const LineSegment& segment : fit_polylines(points, options_for_test()).segments) {
      if (segment.length_m() < 0.15) continue;
      EXPECT_THAT(segment.tangent_rad(), IsNearAngle((90 + 90 * num_walls) * kDegree, 1 * kDegree)) << seed;
      EXPECT_GT(segment.length_m(), 2.7) << seed;
      ++num_walls;
    }
    ASSERT_EQ(num_walls, 2) << seed;
  }
}

TEST(FitPolylines, AnExactWallIsFoundExactly) {
  const PolylineFit fit = fit_polylines(one_wall({3.0, -1.0}, {1.0, 2.0}, 100), options_for_test());
  ASSERT_EQ(fit.segments.size(), 1U);
  EXPECT_THAT(fit.segments[0].start_m, IsNearPoint(Point2(3.0, -1.0), 1e-9));
  EXPECT_THAT(fit.segments[0].end_m, IsNearPoint(Point2(1.0, 2.0), 1e-9));
}

TEST(FitPolylines, AGapInAWallSplitsIt) {
  std::mt19937 rng(3);
  std::vector<ScanPoint> points;
  add_wall(points, {{2.0, -2.0}, {2.0, -0.5}}, 80, 0.005, rng);
  add_wall(points, {{2.0, 0.4}, {2.0, 2.0}}, 80, 0.005, rng);
  const PolylineFit fit = fit_polylines(points, options_for_test());
  ASSERT_EQ(fit.segments.size(), 2U);
  EXPECT_NEAR(fit.segments[0].end_m.y(), -0.5, 0.03);
  EXPECT_NEAR(fit.segments[1].start_m.y(), 0.4, 0.03);
}

TEST(FitPolylines, AGapBehindAnObstacleSplitsTheWallToo) {
  // In scan order there are the wall, the front of a post before it, and the wall again, whose support has a hole.
  std::mt19937 rng(4);
  std::vector<ScanPoint> points;
  add_wall(points, {{2.0, -2.0}, {2.0, -0.4}}, 80, 0.0, rng);
  add_wall(points, {{1.0, -0.2}, {1.0, 0.2}}, 30, 0.0, rng);
  add_wall(points, {{2.0, 0.4}, {2.0, 2.0}}, 80, 0.0, rng);
  const PolylineFit fit = fit_polylines(points, options_for_test());
  ASSERT_EQ(fit.segments.size(), 3U);
  EXPECT_NEAR(fit.segments[0].length_m(), 1.6, 1e-6);
  EXPECT_NEAR(fit.segments[1].length_m(), 0.4, 1e-6);
  EXPECT_NEAR(fit.segments[2].length_m(), 1.6, 1e-6);
}

TEST(FitPolylines, CollinearSegmentsThatAreCloseEndToEndAreMerged) {
  // The simplification follows the ripple, and EM sees through it.
  std::vector<ScanPoint> points;
  for (int i = 0; i <= 300; ++i) {
    const double y_m = -1.5 + 0.01 * i;
    points.push_back({{2.0 + 0.015 * std::sin(6.0 * y_m), y_m}, kBeamSpacing_m});
  }
  PolylineOptions options = options_for_test();
  options.simplify_tolerance_m = 0.01;
  options.em_max_iterations = 0;
  ASSERT_GT(fit_polylines(points, options).segments.size(), 1U);
  options.em_max_iterations = 20;
  EXPECT_EQ(fit_polylines(points, options).segments.size(), 1U);
}

TEST(FitPolylines, ADoorRecessIsNotSwallowedByItsWall) {
  constexpr double kDepth_m = 0.08;
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 rng(seed);
    std::vector<ScanPoint> points;
    add_wall(points, {{2.0, -2.0}, {2.0, -0.45}}, 150, 0.005, rng);
    add_wall(points, {{2.0 + kDepth_m, -0.44}, {2.0 + kDepth_m, 0.44}}, 88, 0.005, rng);
    add_wall(points, {{2.0, 0.45}, {2.0, 2.0}}, 150, 0.005, rng);
    const PolylineFit fit = fit_polylines(points, options_for_test());
    // The middle of the door has a segment of its own, at its depth and along it.
    const LineSegment& door = fit.segments[static_cast<std::size_t>(fit.closest_segment[150 + 44])];
    EXPECT_NEAR(door.distance_m({2.0 + kDepth_m, 0.0}), 0.0, 0.01) << seed;
    EXPECT_THAT(door.tangent_rad(), IsNearAngle(90 * kDegree, 2 * kDegree)) << seed;
    EXPECT_NEAR(door.length_m(), 0.88, 0.1) << seed;
  }
}

TEST(FitPolylines, ALongWallDoesNotOutvoteAShortRecess) {
  std::mt19937 rng(2);
  std::vector<ScanPoint> points;
  add_wall(points, {{2.0, -4.0}, {2.0, -0.11}}, 390, 0.0, rng);
  add_wall(points, {{2.07, -0.10}, {2.07, 0.10}}, 21, 0.0, rng);
  add_wall(points, {{2.0, 0.11}, {2.0, 4.0}}, 390, 0.0, rng);
  const PolylineFit fit = fit_polylines(points, options_for_test());
  const LineSegment& recess = fit.segments[static_cast<std::size_t>(fit.closest_segment[390 + 10])];
  EXPECT_LT(recess.distance_m({2.07, 0.0}), 0.01);
  EXPECT_LT(recess.length_m(), 0.4);
}

TEST(FitPolylines, AWallEndsWhereItsSupportHasAHole) {
  // The first polyline runs straight past a deep recess, whose points it then cannot explain.
  std::mt19937 rng(2);
  std::vector<ScanPoint> points;
  add_wall(points, {{2.0, -2.0}, {2.0, -0.45}}, 150, 0.0, rng);
  add_wall(points, {{2.12, -0.44}, {2.12, 0.44}}, 88, 0.0, rng);
  add_wall(points, {{2.0, 0.45}, {2.0, 2.0}}, 150, 0.0, rng);
  PolylineOptions options = options_for_test();
  options.simplify_tolerance_m = 0.30;
  for (const LineSegment& segment : fit_polylines(points, options).segments) {
    EXPECT_GT(segment.distance_m({2.0, 0.0}), 0.08) << segment.start_m.y() << " to " << segment.end_m.y();
  }
}

TEST(FitPolylines, AnArcIsSeveralChordsThatStayNearIt) {
  std::vector<ScanPoint> points;
  for (int i = 0; i <= 180; ++i) points.push_back({rotate({1.5, 0.0}, i * kDegree), 1.5 * kDegree});
  const PolylineFit fit = fit_polylines(points, options_for_test());
  EXPECT_GE(fit.segments.size(), 4U);
  EXPECT_LE(fit.segments.size(), 20U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_GE(fit.closest_segment[i], 0);
    ASSERT_LT(fit.segments[static_cast<std::size_t>(fit.closest_segment[i])].distance_m(points[i].p_m), 0.08) << i;
  }
}

TEST(FitPolylines, SegmentsPointAlongTheScan) {
  const test::World room = test::uneven_room();
  const test::Scanner scanner;
  std::mt19937 rng(5);
  const Scan scan = test::scan_of(room, {0.3, -0.2, 0.7}, scanner, rng);
  const SweepShape shape = sweep_shape(scan.sweeps[0], 0, {}, options_for_test(), test::paper_options().shape);
  ASSERT_GE(shape.polylines.segments.size(), 8U);
  for (const LineSegment& segment : shape.polylines.segments) {
    // The segments run counterclockwise about the sensor, at the origin.
    EXPECT_GT(segment.start_m.x() * segment.end_m.y() - segment.start_m.y() * segment.end_m.x(), 0.0);
  }
}

TEST(FitPolylines, TurningTheScanOrderTurnsTheSegments) {
  std::vector<ScanPoint> points = one_wall({2.0, -1.0}, {2.0, 1.0}, 50);
  EXPECT_THAT(fit_polylines(points, options_for_test()).segments.at(0).tangent_rad(), IsNearAngle(90 * kDegree, 1e-9));
  std::reverse(points.begin(), points.end());
  EXPECT_THAT(fit_polylines(points, options_for_test()).segments.at(0).tangent_rad(), IsNearAngle(-90 * kDegree, 1e-9));
}

TEST(FitPolylines, ClosestSegmentIsTheNearestOfAll) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const test::World room = test::cluttered_room(seed);
    std::mt19937 rng(seed);
    test::Scanner scanner;
    scanner.noise_m = 0.01;
    const Scan scan = test::scan_of(room, {0.1, 0.2, 0.3}, scanner, rng);
    const SweepShape shape = sweep_shape(scan.sweeps[0], 0, {}, options_for_test(), test::paper_options().shape);
    const PolylineFit& fit = shape.polylines;
    ASSERT_EQ(fit.closest_segment.size(), shape.scan_points.size());
    for (std::size_t i = 0; i < shape.scan_points.size(); ++i) {
      const Point2& p = shape.scan_points[i].p_m;
      double nearest_m = std::numeric_limits<double>::infinity();
      for (const LineSegment& segment : fit.segments) nearest_m = std::min(nearest_m, segment.distance_m(p));
      ASSERT_DOUBLE_EQ(fit.segments.at(static_cast<std::size_t>(fit.closest_segment[i])).distance_m(p), nearest_m);
    }
  }
}

TEST(FitPolylines, EndsBeforeTheLimitAndMoreRoundsChangeNothing) {
  std::mt19937 rng(6);
  std::vector<ScanPoint> points;
  add_wall(points, {{2.0, -2.0}, {2.0, 1.0}}, 150, 0.01, rng);
  add_wall(points, {{1.98, 1.0}, {-1.0, 1.0}}, 150, 0.01, rng);
  PolylineOptions options = options_for_test();
  options.em_max_iterations = 500;
  const PolylineFit stable = fit_polylines(points, options);
  EXPECT_LT(stable.iterations, 500);
  options.em_max_iterations = 1000;
  const PolylineFit longer = fit_polylines(points, options);
  EXPECT_EQ(longer.iterations, stable.iterations);
  ASSERT_EQ(longer.segments.size(), stable.segments.size());
  for (std::size_t s = 0; s < stable.segments.size(); ++s) {
    EXPECT_EQ(longer.segments[s].start_m, stable.segments[s].start_m);
    EXPECT_EQ(longer.segments[s].end_m, stable.segments[s].end_m);
  }
}

TEST(FitPolylines, SegmentsWithTooLittleSupportAreDropped) {
  std::vector<ScanPoint> points = one_wall({2.0, -1.0}, {2.0, 1.0}, 50);
  for (const double y_m : {3.0, 3.1, 3.2}) points.push_back({{0.5, y_m}, kBeamSpacing_m});
  PolylineOptions options = options_for_test();
  options.min_support = 3;
  EXPECT_EQ(fit_polylines(points, options).segments.size(), 2U);
  options.min_support = 4;
  EXPECT_EQ(fit_polylines(points, options).segments.size(), 1U);
}

TEST(FitPolylines, WithoutPointsThereAreNoSegments) {
  const PolylineFit none = fit_polylines({}, options_for_test());
  EXPECT_TRUE(none.segments.empty());
  EXPECT_TRUE(none.closest_segment.empty());
}

TEST(FitPolylines, OnePointHasNoSegmentAndTwoHaveOne) {
  const PolylineFit one = fit_polylines({{{1.0, 1.0}, 0.01}}, options_for_test());
  EXPECT_TRUE(one.segments.empty());
  EXPECT_EQ(one.closest_segment, std::vector<int>{-1});
  const PolylineFit two = fit_polylines({{{1.0, 1.0}, 0.01}, {{1.0, 1.1}, 0.01}}, options_for_test());
  ASSERT_EQ(two.segments.size(), 1U);
  EXPECT_THAT(two.segments[0].tangent_rad(), IsNearAngle(90 * kDegree, 1e-9));
  EXPECT_EQ(two.closest_segment, (std::vector<int>{0, 0}));
}

TEST(FitPolylines, OnePlaceManyTimesHasNoSegment) {
  const std::vector<ScanPoint> points(20, ScanPoint{{1.0, 1.0}, 0.01});
  const PolylineFit fit = fit_polylines(points, options_for_test());
  EXPECT_TRUE(fit.segments.empty());
  EXPECT_EQ(fit.closest_segment, std::vector<int>(20, -1));
}

}  // namespace
}  // namespace shapemap
