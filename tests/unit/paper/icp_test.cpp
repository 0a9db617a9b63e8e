// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/icp.hpp"

#include <gmock/gmock.h>

#include <random>

#include "support/matchers.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::IsNearPose;

constexpr double kMeanDistance_m = 0.05;
const IcpOptions kWholeScan{20, IcpGate::kFactor, 3.0, false};
const OverlapOptions kOverlap{0.40, 10 * kDegree, OverlapRule::kNearest};

PartialMap map_of(const Shape& shape) { return {{shape}, false, 0.5}; }

/// Two scans of one room from two places, and the true motion.
struct TwoViews {
  PartialMap target;
  Shape query;
  Pose2 target_from_query;
};

TwoViews two_views(unsigned seed) {
  const test::World room = test::cluttered_room(seed);
  const Pose2 motion{0.25, -0.15, 1.5 * kDegree};
  return {map_of(test::shape_from(room, {})), test::shape_from(room, motion), motion};
}

TEST(FitPose, IsExactOnPartnersWithoutNoise) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> any(-5.0, 5.0);
    const Pose2 truth{any(rng), any(rng), wrap_angle(any(rng))};
    Shape query;
    std::vector<Partner> partners;
    const std::size_t count = 2 + seed % 10;
    for (std::size_t i = 0; i < count; ++i) {
      const double x_m = any(rng);
      query.points.push_back({{x_m, any(rng)}, 0.0, 0});
      partners.push_back({i, count - 1 - i, 0.0});
    }
    Shape target = moved(query, truth);
    std::reverse(target.points.begin(), target.points.end());
    EXPECT_THAT(fit_pose(map_of(target), query, partners), IsNearPose(truth, 1e-9, 1e-9)) << seed;
  }
}

TEST(FitPose, NoOtherPoseNearbyHasSmallerSquares) {
  std::mt19937 rng(1);
  std::normal_distribution<double> noise(0.0, 0.05);
  const Shape query = test::shape_from(test::uneven_room(), {});
  Shape target = moved(query, {0.3, 0.2, 0.1});
  std::vector<Partner> partners;
  for (std::size_t i = 0; i < query.size(); ++i) {
    target.points[i].p_m += Point2(noise(rng), 2 * noise(rng));
    partners.push_back({i, i, 0.0});
  }
  const auto squares = [&](const Pose2& pose) {
    double sum = 0.0;
    for (std::size_t i = 0; i < query.size(); ++i) {
      sum += (pose * query.points[i].p_m - target.points[i].p_m).squaredNorm();
    }
    return sum;
  };
  const Pose2 best = fit_pose(map_of(target), query, partners);
  for (const Pose2& step : {Pose2{1e-3, 0, 0}, Pose2{0, 1e-3, 0}, Pose2{0, 0, 1e-3}}) {
    EXPECT_GT(squares({best.x_m + step.x_m, best.y_m + step.y_m, best.theta_rad + step.theta_rad}), squares(best));
    EXPECT_GT(squares({best.x_m - step.x_m, best.y_m - step.y_m, best.theta_rad - step.theta_rad}), squares(best));
  }
}

TEST(Icp, ConvergesFromFiveCentimetresAndTwoDegrees) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const TwoViews views = two_views(seed);
    const double bearing_rad = seed * 36 * kDegree;
    const Point2 off = rotate({0.05, 0.0}, bearing_rad);
    const double turn_rad = (seed % 2 == 0 ? 2 : -2) * kDegree;
    const Pose2& truth = views.target_from_query;
    const Pose2 start{truth.x_m + off.x(), truth.y_m + off.y(), truth.theta_rad + turn_rad};
    const IcpResult result = icp(views.target, views.query, {start, kMeanDistance_m}, kWholeScan, kOverlap);
    EXPECT_THAT(result.target_from_query, IsNearPose(truth, 0.02, 0.4 * kDegree)) << seed;
    EXPECT_GT(result.iterations, 0);
  }
}

TEST(Icp, StaysAtTheTruthOfTwoIdenticalScans) {
  const Shape shape = test::shape_from(test::uneven_room(), {});
  for (const IcpGate gate : {IcpGate::kFactor, IcpGate::kSlack}) {
    IcpOptions options = kWholeScan;
    options.gate = gate;
    const IcpResult result = icp(map_of(shape), shape, {}, options, kOverlap);
    EXPECT_THAT(result.target_from_query, IsNearPose(Pose2{}, 1e-9, 1e-9));
    EXPECT_EQ(result.overlap.num_points, static_cast<int>(shape.size()));
  }
}

TEST(Icp, WithoutIterationsIsTheStart) {
  const TwoViews views = two_views(1);
  const Pose2 start{0.3, -0.1, 0.02};
  IcpOptions options = kWholeScan;
  options.max_iterations = 0;
  const IcpResult result = icp(views.target, views.query, {start, kMeanDistance_m}, options, kOverlap);
  EXPECT_THAT(result.target_from_query, HasSameBits(start));
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(result.steps.size(), 1U);
  EXPECT_GT(result.overlap.num_points, 0);
}

TEST(Icp, FarFromEverythingIsTheStart) {
  const TwoViews views = two_views(2);
  const Pose2 start{100.0, 0.0, 0.0};
  const IcpResult result = icp(views.target, views.query, {start, kMeanDistance_m}, kWholeScan, kOverlap);
  EXPECT_THAT(result.target_from_query, HasSameBits(start));
  EXPECT_EQ(result.overlap.num_points, 0);
}

TEST(Icp, NeverKeepsAStepThatOverlapsLessAtALargerDistance) {
  int num_steps = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const TwoViews views = two_views(seed);
    const Pose2 start{0.25 - 0.02 * seed, 0.02 * seed, 3 * kDegree};
    const IcpResult result = icp(views.target, views.query, {start, kMeanDistance_m}, kWholeScan, kOverlap);
    ASSERT_EQ(result.steps.size(), static_cast<std::size_t>(result.iterations) + 1);
    EXPECT_THAT(result.steps.front(), HasSameBits(start));
    EXPECT_THAT(result.steps.back(), HasSameBits(result.target_from_query));
    // The limit that the overlap of all steps is measured with.
    const auto overlap_at = [&](const Pose2& pose, double limit_m) {
      return scan_overlap(partners_within(views.target, views.query, pose, {limit_m}, kOverlap));
    };
    const double limit_m = overlap_at(start, kMeanDistance_m + 0.40).mean_distance_m + 0.40;
    ScanOverlap before = overlap_at(start, limit_m);
    for (std::size_t k = 1; k < result.steps.size(); ++k) {
      const ScanOverlap after = overlap_at(result.steps[k], limit_m);
      EXPECT_FALSE(after.num_points < before.num_points && after.mean_distance_m > before.mean_distance_m);
      before = after;
      ++num_steps;
    }
    EXPECT_EQ(result.overlap.num_points, before.num_points);
    EXPECT_DOUBLE_EQ(result.overlap.mean_distance_m, before.mean_distance_m);
  }
  EXPECT_GT(num_steps, 40);
}

TEST(Icp, RollsBackAStepThatLosesPartnersAndMovesTheOthersAway) {
  // On a line, by how far each target lies from its query point. The pull of the six moves the twenty away, and the
  // one behind out of reach: squares fall, the mean rises.
  std::vector<double> offsets_m(20, 0.0);
  offsets_m.insert(offsets_m.end(), 6, 0.20);
  offsets_m.push_back(-0.25);
  Shape target;
  Shape query;
  std::vector<Partner> all;
  for (std::size_t i = 0; i < offsets_m.size(); ++i) {
    query.points.push_back({{static_cast<double>(i), 0.0}, 0.0, 0});
    target.points.push_back({{static_cast<double>(i) + offsets_m[i], 0.0}, 0.0, 0});
    all.push_back({i, i, std::abs(offsets_m[i])});
  }
  const PartialMap map = map_of(target);
  const OverlapOptions overlap_options{0.20, 10 * kDegree, OverlapRule::kNearest};
  const double limit_m = scan_overlap(all).mean_distance_m + 0.20;
  const ScanOverlap after =
      scan_overlap(partners_within(map, query, fit_pose(map, query, all), {limit_m}, overlap_options));
  ASSERT_LT(after.num_points, 27);
  ASSERT_GT(after.mean_distance_m, scan_overlap(all).mean_distance_m);

  IcpOptions options = kWholeScan;
  options.gate = IcpGate::kSlack;
  const IcpResult result = icp(map, query, {{}, 0.06}, options, overlap_options);
  EXPECT_THAT(result.target_from_query, HasSameBits(Pose2{}));
  EXPECT_EQ(result.iterations, 0);
  EXPECT_EQ(result.steps.size(), 1U);
  EXPECT_EQ(result.overlap.num_points, 27);
}

TEST(Icp, KeepsAtMostTheIterationsAskedFor) {
  const TwoViews views = two_views(3);
  IcpOptions options = kWholeScan;
  for (const int limit : {1, 2, 3}) {
    options.max_iterations = limit;
    const IcpResult result = icp(views.target, views.query, {{0.15, 0.0, 0.0}, kMeanDistance_m}, options, kOverlap);
    EXPECT_LE(result.iterations, limit);
    EXPECT_GT(result.iterations, 0);
  }
}

/// A scan of four sub-scans of which one is turned by a small error, and the scan as it should be.
struct TurnedSweep {
  test::World world;
  Shape right;
  Shape wrong;
};

TurnedSweep turned_sweep(int sweep, const Pose2& error, double spacing_m = 0.05) {
  test::Scanner scanner;
  scanner.num_sweeps = 4;
  scanner.num_beams = 401;
  scanner.view_rad = 100 * kDegree;
  MappingOptions options = test::paper_options();
  options.shape.spacing_m = spacing_m;
  const test::World world = test::cluttered_room(2);
  const Shape right = test::shape_of(test::scan_of(world, {}, scanner), options);
  std::vector<Pose2> errors(4);
  errors[static_cast<std::size_t>(sweep)] = error;
  return {world, right, moved(right, {}, errors)};
}

/// Mean distance of the points of a sub-scan to the nearest wall.
double off_the_walls_m(const test::World& world, const Shape& shape, int sweep) {
  double sum_m = 0.0;
  int count = 0;
  for (const ShapePoint& point : shape.points) {
    if (point.sweep != sweep) continue;
    sum_m += test::distance_to_walls_m(world, point.p_m);
    ++count;
  }
  return sum_m / count;
}

TEST(DecoupledIcp, FindsASubScanThatIsTurnedByOneDegree) {
  // Partners are points: how close they come to the truth is limited by the spacing of the points.
  for (int s = 0; s < 4; ++s) {
    const Pose2 error{0.0, 0.0, 1 * kDegree};
    const TurnedSweep scans = turned_sweep(s, error, 0.01);
    const std::vector<Pose2> found =
        decoupled_icp(map_of(scans.right), scans.wrong, {{}, kMeanDistance_m}, kWholeScan, kOverlap);
    ASSERT_EQ(found.size(), 4U);
    for (int k = 0; k < 4; ++k) {
      const Pose2 expected = k == s ? inverse(error) : Pose2{};
      EXPECT_THAT(found[static_cast<std::size_t>(k)], IsNearPose(expected, 0.015, 0.25 * kDegree)) << s << ", " << k;
    }
  }
}

TEST(DecoupledIcp, BringsATurnedSubScanBackTowardsTheWallsAtAnySpacing) {
  for (const double spacing_m : {0.01, 0.02, 0.05}) {
    for (int s = 0; s < 4; ++s) {
      const TurnedSweep scans = turned_sweep(s, {0.0, 0.0, 1 * kDegree}, spacing_m);
      const std::vector<Pose2> found =
          decoupled_icp(map_of(scans.right), scans.wrong, {{}, kMeanDistance_m}, kWholeScan, kOverlap);
      const double before_m = off_the_walls_m(scans.world, scans.wrong, s);
      const double after_m = off_the_walls_m(scans.world, moved(scans.wrong, {}, found), s);
      EXPECT_GT(before_m, 0.02);
      EXPECT_LT(after_m, 0.75 * before_m) << s << ", " << spacing_m;
    }
  }
}

TEST(DecoupledIcp, CorrectionsAreInTheFrameOfTheQuery) {
  const TurnedSweep scans = turned_sweep(1, {0.0, 0.0, 1 * kDegree});
  const Pose2 map_from_query{3.0, -2.0, 2.0};
  const std::vector<Pose2> here =
      decoupled_icp(map_of(scans.right), scans.wrong, {{}, kMeanDistance_m}, kWholeScan, kOverlap);
  const std::vector<Pose2> there = decoupled_icp(map_of(moved(scans.right, map_from_query)), scans.wrong,
                                                 {map_from_query, kMeanDistance_m}, kWholeScan, kOverlap);
  for (std::size_t s = 0; s < 4; ++s) EXPECT_THAT(there[s], IsNearPose(here[s], 1e-3, 0.05 * kDegree)) << s;
}

TEST(DecoupledIcp, LeavesAScanOfOneSubScanAlone) {
  const TwoViews views = two_views(4);
  const std::vector<Pose2> found =
      decoupled_icp(views.target, views.query, {{0.2, -0.1, 0.0}, kMeanDistance_m}, kWholeScan, kOverlap);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0], HasSameBits(Pose2{}));
}

TEST(DecoupledIcp, LeavesASubScanAloneThatNothingPulls) {
  TurnedSweep scans = turned_sweep(2, {50.0, 0.0, 0.0});
  const std::vector<Pose2> found =
      decoupled_icp(map_of(scans.right), scans.wrong, {{}, kMeanDistance_m}, kWholeScan, kOverlap);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_THAT(found[2], IsNearPose(Pose2{}, 1e-12, 1e-12));
}

}  // namespace
}  // namespace shapemap
