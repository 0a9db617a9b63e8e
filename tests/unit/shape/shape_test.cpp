// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/shape.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "support/matchers.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

using test::IsNearAngle;
using test::IsNearPoint;

/// One laser sees a wall 2 m ahead that is `length_m` long.
Scan before_a_wall(double length_m) {
  const test::World wall{{{2.0, -length_m / 2}, {2.0, length_m / 2}}};
  test::Scanner scanner;
  scanner.num_beams = 3600;
  return test::scan_of(wall, {}, scanner);
}

TEST(Shape, ResampledPointsAreEquallySpacedAlongTheWall) {
  MappingOptions options = test::paper_options();
  options.shape.spacing_m = 0.1;
  const Shape shape = test::shape_of(before_a_wall(2.0), options);
  ASSERT_EQ(shape.size(), 20U);
  for (std::size_t i = 0; i < shape.size(); ++i) {
    EXPECT_THAT(shape.points[i].p_m, IsNearPoint(Point2(2.0, -0.95 + 0.1 * static_cast<double>(i)), 0.005)) << i;
    EXPECT_THAT(shape.points[i].tangent_rad, IsNearAngle(90 * kDegree, 1e-3)) << i;
  }
}

TEST(Shape, TheNumberOfResampledPointsFollowsTheSpacing) {
  MappingOptions options = test::paper_options();
  for (const auto& [spacing_m, count] : {std::pair{0.05, 40U}, {0.1, 20U}, {0.5, 4U}, {1.0, 2U}}) {
    options.shape.spacing_m = spacing_m;
    EXPECT_EQ(test::shape_of(before_a_wall(2.0), options).size(), count) << spacing_m;
  }
}

TEST(Shape, WithTooManyPointsIsThinnedOutEvenly) {
  MappingOptions options = test::paper_options();
  options.shape.spacing_m = 0.01;
  options.shape.max_points = 100;
  const Shape shape = test::shape_of(before_a_wall(2.0), options);  // there are 200 points without the limit
  ASSERT_EQ(shape.size(), 100U);
  for (std::size_t i = 1; i < shape.size(); ++i) {
    EXPECT_NEAR((shape.points[i].p_m - shape.points[i - 1].p_m).norm(), 0.02, 0.002) << i;
  }
}

TEST(Shape, AShortSegmentGivesItsMiddle) {
  MappingOptions options = test::paper_options();
  options.shape.spacing_m = 1.0;
  const Shape shape = test::shape_of(before_a_wall(0.3), options);
  ASSERT_EQ(shape.size(), 1U);
  EXPECT_THAT(shape.points[0].p_m, IsNearPoint(Point2(2.0, 0.0), 0.005));
}

TEST(Shape, OfBeamsHasThePointsOfTheScan) {
  MappingOptions options = test::paper_options();
  options.shape.points = ShapePoints::kBeams;
  const Scan scan = before_a_wall(2.0);
  const std::vector<Return> returns = returns_in_robot(scan.sweeps[0], options.returns);
  const Shape shape = test::shape_of(scan, options);
  ASSERT_GT(returns.size(), 100U);
  ASSERT_EQ(shape.size(), returns.size());
  for (std::size_t i = 0; i < shape.size(); ++i) {
    ASSERT_EQ(shape.points[i].p_m, returns[i].p_in_robot_m);
    ASSERT_THAT(shape.points[i].tangent_rad, IsNearAngle(90 * kDegree, 1e-3));
  }
}

TEST(Shape, DoesNotDependOnTheDensityOfBeams) {
  const test::World room = test::uneven_room();
  test::Scanner coarse;
  coarse.num_beams = 720;
  test::Scanner fine;
  fine.num_beams = 2880;
  const Shape a = test::shape_from(room, {}, coarse);
  const Shape b = test::shape_from(room, {}, fine);
  EXPECT_NEAR(static_cast<double>(a.size()), static_cast<double>(b.size()), 0.05 * static_cast<double>(b.size()));
}

TEST(Shape, PointsKnowTheirSweepAndComeInItsOrder) {
  test::Scanner scanner;
  scanner.num_sweeps = 4;
  scanner.num_beams = 401;
  scanner.view_rad = 100 * kDegree;
  const Shape shape = test::shape_from(test::uneven_room(), {}, scanner);
  EXPECT_EQ(shape.num_sweeps, 4);
  std::vector<int> points_of(4, 0);
  int before = 0;
  for (const ShapePoint& point : shape.points) {
    EXPECT_GE(point.sweep, before);
    before = point.sweep;
    ++points_of.at(static_cast<std::size_t>(point.sweep));
    // Each sweep sees 50 degrees to either side of its heading.
    const double bearing_rad = std::atan2(point.p_m.y(), point.p_m.x());
    EXPECT_LT(angle_between(bearing_rad, point.sweep * 90 * kDegree), 51 * kDegree);
  }
  for (const int count : points_of) EXPECT_GT(count, 10);
}

TEST(Shape, LiesOnTheWalls) {
  const test::World room = test::uneven_room();
  const Pose2 world_from_robot{0.5, -0.4, 2.0};
  const Shape shape = test::shape_from(room, world_from_robot);
  ASSERT_GT(shape.size(), 200U);
  for (const ShapePoint& point : shape.points) {
    EXPECT_LT(test::distance_to_walls_m(room, world_from_robot * point.p_m), 0.01);
  }
}

TEST(Shape, OfAScanWithoutReturnsIsEmpty) {
  Scan blind = before_a_wall(2.0);
  for (float& range_m : blind.sweeps[0].ranges_m) range_m = std::nanf("");
  const Shape shape = test::shape_of(blind, test::paper_options());
  EXPECT_EQ(shape.size(), 0U);
  EXPECT_EQ(shape.num_sweeps, 1);
  EXPECT_EQ(test::shape_of(Scan{}, test::paper_options()).size(), 0U);
}

TEST(MovedShape, HasMovedPointsAndTurnedTangents) {
  const Shape shape{{{{1.0, 2.0}, 170 * kDegree, 0}, {{-1.0, 0.5}, -20 * kDegree, 0}}, 1};
  const Shape result = moved(shape, {3.0, -1.0, 90 * kDegree});
  EXPECT_THAT(result.points[0].p_m, IsNearPoint(Point2(1.0, 0.0), 1e-12));
  EXPECT_THAT(result.points[1].p_m, IsNearPoint(Point2(2.5, -2.0), 1e-12));
  EXPECT_THAT(result.points[0].tangent_rad, IsNearAngle(260 * kDegree, 1e-12));
  EXPECT_THAT(result.points[1].tangent_rad, IsNearAngle(70 * kDegree, 1e-12));
}

TEST(MovedShape, TangentsWrapToHalfATurn) {
  Shape shape{{{{1.0, 2.0}, 0.0, 0}}, 1};
  for (int degrees = -360; degrees <= 360; degrees += 5) {
    shape.points[0].tangent_rad = degrees * kDegree;
    const double tangent_rad = moved(shape, {0.0, 0.0, 100 * kDegree}).points[0].tangent_rad;
    EXPECT_LE(std::abs(tangent_rad), kPi + 1e-12);
    EXPECT_THAT(tangent_rad, IsNearAngle((degrees + 100) * kDegree, 1e-9));
  }
}

TEST(MovedShape, AppliesTheSweepPosesFirst) {
  const Shape shape{{{{1.0, 0.0}, 0.1, 0}, {{0.0, 1.0}, 0.2, 1}, {{-1.0, 0.0}, 0.3, 1}}, 2};
  const std::vector<Pose2> sweep_poses{{0.01, 0.02, 0.03}, {-0.04, 0.05, -0.06}};
  const Pose2 b_from_a{2.0, 1.0, 0.5};
  const Shape result = moved(shape, b_from_a, sweep_poses);
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const Pose2& first = sweep_poses[static_cast<std::size_t>(shape.points[i].sweep)];
    EXPECT_THAT(result.points[i].p_m, IsNearPoint(b_from_a * (first * shape.points[i].p_m), 1e-12));
    EXPECT_THAT(result.points[i].tangent_rad,
                IsNearAngle(shape.points[i].tangent_rad + first.theta_rad + b_from_a.theta_rad, 1e-12));
    EXPECT_EQ(result.points[i].sweep, shape.points[i].sweep);
  }
}

}  // namespace
}  // namespace shapemap
