// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/point_to_line.hpp"

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "support/matchers.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

using test::IsNearPose;

bool is_finite(const LineFit& fit) {
  const Pose2& pose = fit.ref_from_query;
  return std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.theta_rad) &&
         fit.information.allFinite() && std::isfinite(fit.rms_m) && std::isfinite(fit.lever_m);
}

ScanView view_of_points(const std::vector<ShapePoint>& points) {
  ScanView view;
  std::vector<Point2> places_m;
  for (const ShapePoint& point : points) {
    view.points.push_back(point);
    view.directions.emplace_back(std::cos(point.tangent_rad), std::sin(point.tangent_rad));
    view.weights.push_back(1.0);
    view.cross_weights.push_back(1.0);
    places_m.push_back(point.p_m);
  }
  view.index = PointIndex(std::move(places_m));
  return view;
}

TEST(FitToLines, FindsThePoseFromAFewDecimetresAndDegreesOff) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (unsigned seed = 0; seed < 40; ++seed) {
    const test::World world = test::cluttered_room(seed, 4);
    const Pose2 truth{0.5 * unit(rng), 0.5 * unit(rng), 3.0 * unit(rng)};
    const ScanView reference = test::view_from(world, {}, test::full_circle(), 1);
    const ScanView query = test::view_from(world, truth, test::full_circle(), 2);
    const Point2 off_m = rotate({0.3, 0.0}, kPi * unit(rng));
    const Pose2 start{truth.x_m + off_m.x(), truth.y_m + off_m.y(), truth.theta_rad + 10 * kDegree * unit(rng)};
    PointToLineOptions options;
    options.max_iterations = 40;
    const LineFit fit = fit_to_lines(reference, query, start, options);
    EXPECT_THAT(fit.ref_from_query, IsNearPose(truth, 0.03, 0.7 * kDegree)) << seed;
    EXPECT_GT(fit.partners, static_cast<int>(query.size()) / 2);
    EXPECT_LT(fit.rms_m, 0.06);
    EXPECT_GT(fit.lever_m, 1.0);
  }
}

TEST(FitToLines, StaysAtThePoseOfACopy) {
  const ScanView view = test::view_from(test::cluttered_room(3), {0.2, 0.1, 0.3});
  EXPECT_THAT(fit_to_lines(view, view, {}, {}).ref_from_query, IsNearPose(Pose2{}, 1e-9, 1e-9));
}

TEST(FitToLines, DoesNotSlideAlongABareCorridor) {
  test::Scanner scanner = test::half_circle();
  scanner.max_range_m = 8.0;
  const test::World world = test::bare_corridor();
  const ScanView reference = test::view_from(world, {}, scanner, 1);
  const ScanView query = test::view_from(world, {}, scanner, 2);
  for (const double along_m : {-1.0, -0.3, 0.0, 0.4, 1.5}) {
    const LineFit fit = fit_to_lines(reference, query, {along_m, 0.15, 4 * kDegree}, {});
    EXPECT_NEAR(fit.ref_from_query.x_m, along_m, 0.10) << "nothing holds it, nothing moves it";
    EXPECT_NEAR(fit.ref_from_query.y_m, 0.0, 0.03) << "the walls hold it";
    EXPECT_NEAR(fit.ref_from_query.theta_rad, 0.0, 1 * kDegree);
  }
}

TEST(FitToLines, InformationIsThatOfItsPartners) {
  const ScanView view = test::view_from(test::cluttered_room(3), {});
  const LineFit fit = fit_to_lines(view, view, {}, {});
  EXPECT_EQ(fit.partners, static_cast<int>(view.size()));
  EXPECT_NEAR(fit.information(0, 0) + fit.information(1, 1), fit.partners, 1e-6) << "normals have unit length";
  EXPECT_NEAR((fit.information - fit.information.transpose()).norm(), 0.0, 1e-9);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(fit.information);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), 0.0);
}

TEST(FitToLines, OfTwoPointsOrFewerLeavesThePoseAsItIs) {
  const ScanView room = test::view_from(test::cluttered_room(3), {});
  const Pose2 start{0.1, -0.2, 0.3};
  for (std::size_t count = 0; count <= 2; ++count) {
    std::vector<ShapePoint> few(room.points.begin(), room.points.begin() + static_cast<std::ptrdiff_t>(count));
    const ScanView view = view_of_points(few);
    for (const LineFit& fit : {fit_to_lines(view, room, start, {}), fit_to_lines(room, view, start, {}),
                               fit_to_lines(view, view, start, {})}) {
      EXPECT_TRUE(is_finite(fit)) << count;
      EXPECT_LE((fit.ref_from_query.translation() - start.translation()).norm(), 1.0);
    }
    EXPECT_EQ(fit_to_lines(room, view, start, {}).ref_from_query, start);
  }
}

TEST(FitToLines, IsFiniteForPointsThatHoldNothing) {
  const std::vector<ShapePoint> one_place(20, ShapePoint{{1.0, 1.0}, 0.5, 0});
  std::vector<ShapePoint> one_line;
  for (int k = 0; k < 20; ++k) one_line.push_back({{0.1 * k, 1.0}, 0.0, 0});
  for (const ScanView& view : {view_of_points(one_place), view_of_points(one_line)}) {
    for (const double stiffness : {0.0, 0.02, 10.0}) {
      PointToLineOptions options;
      options.stiffness = stiffness;
      options.max_iterations = 1000;
      EXPECT_TRUE(is_finite(fit_to_lines(view, view, {0.05, 0.02, 0.03}, options)));
    }
  }
}

TEST(FitToLines, OfNoIterationsIsTheStart) {
  const ScanView view = test::view_from(test::cluttered_room(3), {});
  PointToLineOptions options;
  options.max_iterations = 0;
  const LineFit fit = fit_to_lines(view, view, {0.1, 0.2, 0.3}, options);
  EXPECT_EQ(fit.ref_from_query, (Pose2{0.1, 0.2, 0.3}));
  EXPECT_EQ(fit.partners, 0);
}

TEST(FitToLines, TurnsWithTheQuery) {
  const test::World world = test::cluttered_room(4);
  const ScanView reference = test::view_from(world, {});
  std::mt19937 rng(2);
  const Scan query = test::scan_of(world, {0.2, -0.1, 0.1}, test::full_circle(), rng);
  const Pose2 start{0.1, 0.0, 0.05};
  const Pose2 found = fit_to_lines(reference, test::view_of(query), start, {}).ref_from_query;
  for (const double turn_rad : {-2.0, 0.5, 3.0}) {
    const Pose2 turn{0.0, 0.0, turn_rad};
    const ScanView turned = test::view_of(test::turned(query, turn_rad));
    EXPECT_THAT(fit_to_lines(reference, turned, start * inverse(turn), {}).ref_from_query * turn,
                IsNearPose(found, 1e-6, 1e-6));
  }
}

}  // namespace
}  // namespace shapemap
