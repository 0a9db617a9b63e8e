// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/paper_align.hpp"

#include <gmock/gmock.h>

#include <random>

#include "support/matchers.hpp"
#include "support/synthetic_world.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using test::IsNanPose;
using test::IsNearPose;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

PaperOptions options_for_test() { return test::paper_options().paper; }

std::vector<int> grid_in_degrees(double range_deg, double step_deg) {
  std::vector<int> degrees;
  for (const double rotation_rad : rotation_grid({range_deg * kDegree, step_deg * kDegree})) {
    degrees.push_back(static_cast<int>(std::lround(rotation_rad / kDegree)));
  }
  return degrees;
}

TEST(RotationGrid, IsThePapersFiveRotations) { EXPECT_THAT(grid_in_degrees(2, 1), ElementsAre(-2, -1, 0, 1, 2)); }

TEST(RotationGrid, OfNoRangeIsNoTurn) { EXPECT_THAT(grid_in_degrees(0, 1), ElementsAre(0)); }

TEST(RotationGrid, HasMultiplesOfTheStepWithinTheRange) {
  EXPECT_THAT(grid_in_degrees(5, 2), ElementsAre(-4, -2, 0, 2, 4));
  EXPECT_THAT(grid_in_degrees(1, 2), ElementsAre(0));
}

TEST(RotationGrid, AFullTurnHasNoDirectionTwice) {
  for (const double step_deg : {1.0, 0.5, 10.0, 7.0, 60.0, 90.0, 180.0}) {
    const std::vector<double> grid = rotation_grid({180 * kDegree, step_deg * kDegree});
    for (std::size_t i = 0; i < grid.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) ASSERT_GT(angle_between(grid[i], grid[k]), 0.01 * kDegree) << step_deg;
    }
    EXPECT_EQ(grid.size(),
              static_cast<std::size_t>(2 * std::floor(180 / step_deg)) + (std::fmod(180.0, step_deg) == 0.0 ? 0 : 1));
  }
}

/// Two scans of a cluttered room, and the true motion between them.
struct TwoViews {
  Shape reference;
  Shape query;
  Pose2 ref_from_query;
};

TwoViews two_views(unsigned seed, double turn_deg, double distance_m) {
  const test::World room = test::cluttered_room(seed);
  std::mt19937 rng(seed + 1000);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Pose2 world_from_ref{0.4 * unit(rng) - 0.2, 0.4 * unit(rng) - 0.2, 2 * kPi * unit(rng)};
  const Point2 step = rotate({distance_m, 0.0}, 2 * kPi * unit(rng));
  const Pose2 ref_from_query{step.x(), step.y(), turn_deg * kDegree};
  test::Scanner scanner;
  scanner.noise_m = 0.005;
  return {test::shape_from(room, world_from_ref, scanner, seed),
          test::shape_from(room, world_from_ref * ref_from_query, scanner, seed + 1), ref_from_query};
}

class PaperAlignSeeds : public ::testing::TestWithParam<unsigned> {};

TEST_P(PaperAlignSeeds, FindsAKnownMotionInAClutteredRoom) {
  const unsigned seed = GetParam();
  std::mt19937 rng(seed);
  const double turn_deg = std::uniform_real_distribution<double>(-2.0, 2.0)(rng);
  const TwoViews views = two_views(seed, turn_deg, 0.5);
  const PaperAlignment found = paper_align(views.reference, views.query, options_for_test());
  ASSERT_TRUE(found.ok()) << found.reason;
  EXPECT_THAT(found.ref_from_query, IsNearPose(views.ref_from_query, 0.05, 1 * kDegree));
}

INSTANTIATE_TEST_SUITE_P(Seeds, PaperAlignSeeds, ::testing::Range(0U, 50U));

TEST(PaperAlign, FindsALargeTurnWithAWideGrid) {
  PaperOptions options = options_for_test();
  options.rotation = {60 * kDegree, 2 * kDegree};
  for (const unsigned seed : {1U, 2U, 3U}) {
    const TwoViews views = two_views(seed, 40.0, 0.3);
    const PaperAlignment found = paper_align(views.reference, views.query, options);
    ASSERT_TRUE(found.ok()) << found.reason;
    EXPECT_THAT(found.ref_from_query, IsNearPose(views.ref_from_query, 0.05, 1 * kDegree)) << seed;
    EXPECT_NEAR(found.rotation_rad, 40 * kDegree, 4.1 * kDegree);
  }
}

TEST(PaperAlign, FindsTheMotionWithThePapersLiteralReadingsToo) {
  MappingOptions strict = test::paper_options();
  make_strict_paper(strict);
  const test::World room = test::cluttered_room(5);
  const Pose2 motion{0.2, 0.1, 1 * kDegree};
  const Shape reference = test::shape_of(test::scan_of(room, {}), strict);
  const Shape query = test::shape_of(test::scan_of(room, motion), strict);
  const PaperAlignment found = paper_align(reference, query, strict.paper);
  ASSERT_TRUE(found.ok()) << found.reason;
  EXPECT_THAT(found.ref_from_query, IsNearPose(motion, 0.10, 1.5 * kDegree));
}

TEST(PaperAlign, TwoIdenticalScansAreAtTheSamePlace) {
  const Shape shape = test::shape_from(test::cluttered_room(1), {});
  const PaperAlignment found = paper_align(shape, shape, options_for_test());
  ASSERT_TRUE(found.ok()) << found.reason;
  EXPECT_THAT(found.ref_from_query, IsNearPose(Pose2{}, 1e-6, 1e-6));
  EXPECT_EQ(found.overlap_ratio, 1.0);
}

TEST(PaperAlign, WithoutShapeIsRefusedWithTheNumbers) {
  const Shape shape = test::shape_from(test::uneven_room(), {});
  Shape few = shape;
  few.points.resize(9);
  for (const auto& [reference, query] : {std::pair{few, shape}, {shape, few}, {Shape{}, Shape{}}}) {
    PaperTrace trace;
    trace.best_rotation = 2;
    trace.rotations.resize(5);
    const PaperAlignment refused = paper_align(reference, query, options_for_test(), {}, &trace);
    EXPECT_EQ(refused.status, PaperStatus::kNoShape);
    EXPECT_EQ(trace.best_rotation, -1) << "nothing is left of an earlier alignment";
    EXPECT_TRUE(trace.rotations.empty());
    EXPECT_THAT(refused.reason, HasSubstr("10 are needed"));
    EXPECT_THAT(refused.ref_from_query, IsNanPose());
  }
}

/// A straight row of points.
Shape row(double tangent_rad) {
  Shape shape;
  shape.num_sweeps = 1;
  for (int i = 0; i < 40; ++i) shape.points.push_back({rotate({0.05 * i, 1.0}, tangent_rad), tangent_rad, 0});
  return shape;
}

TEST(PaperAlign, WithoutSimilarTangentsIsRefused) {
  PaperTrace trace;
  const PaperAlignment refused = paper_align(row(0.0), row(kPi / 2), options_for_test(), {}, &trace);
  EXPECT_EQ(refused.status, PaperStatus::kNoCorrespondences);
  EXPECT_FALSE(refused.reason.empty());
  EXPECT_THAT(refused.ref_from_query, IsNanPose());
  EXPECT_EQ(trace.best_rotation, -1);
  EXPECT_EQ(trace.rotations.size(), 5U);
}

TEST(PaperAlign, WithFewerCorrespondencesThanAskedForIsRefused) {
  const Shape shape = test::shape_from(test::cluttered_room(1), {});
  PaperOptions options = options_for_test();
  options.trust.min_correspondences = static_cast<int>(shape.size()) + 1;
  const PaperAlignment refused = paper_align(shape, shape, options);
  EXPECT_EQ(refused.status, PaperStatus::kTooFewCorrespondences);
  EXPECT_THAT(refused.reason, HasSubstr(std::to_string(options.trust.min_correspondences) + " are needed"));
  EXPECT_THAT(refused.ref_from_query, IsNanPose());
}

TEST(PaperAlign, WithLessOverlapThanAskedForIsRefused) {
  const TwoViews views = two_views(2, 1.0, 0.5);
  PaperOptions options = options_for_test();
  options.trust.min_overlap_ratio = 1.0;
  const PaperAlignment refused = paper_align(views.reference, views.query, options);
  EXPECT_EQ(refused.status, PaperStatus::kTooLittleOverlap);
  EXPECT_THAT(refused.reason, HasSubstr("1 is needed"));
  EXPECT_THAT(refused.ref_from_query, IsNanPose());
  EXPECT_FALSE(std::isnan(refused.icp_ref_from_query.x_m));  // what was refused can be looked at
}

TEST(PaperAlignment, HasNoPoseBeforeThereIsAResult) {
  EXPECT_FALSE(PaperAlignment{}.ok());
  EXPECT_THAT(PaperAlignment{}.ref_from_query, IsNanPose());
}

void expect_same_bits(const PaperAlignment& a, const PaperAlignment& b) {
  EXPECT_EQ(a.status, b.status);
  EXPECT_THAT(a.ref_from_query, HasSameBits(b.ref_from_query));
  EXPECT_THAT(a.shape_ref_from_query, HasSameBits(b.shape_ref_from_query));
  EXPECT_EQ(a.num_correspondences, b.num_correspondences);
  EXPECT_EQ(a.overlap, b.overlap);
  EXPECT_EQ(a.icp_iterations, b.icp_iterations);
  ASSERT_EQ(a.query_from_sweep.size(), b.query_from_sweep.size());
  for (std::size_t s = 0; s < a.query_from_sweep.size(); ++s) {
    EXPECT_THAT(a.query_from_sweep[s], HasSameBits(b.query_from_sweep[s]));
  }
}

TEST(PaperAlign, IsTheSameToTheBitForAnyNumberOfThreads) {
  const TwoViews views = two_views(3, -1.5, 0.5);
  PaperOptions options = options_for_test();
  options.rotation = {6 * kDegree, 1 * kDegree};
  options.icp.decoupled = true;
  const PaperAlignment one = paper_align(views.reference, views.query, options, {1});
  for (const int threads : {2, 4, 32}) {
    expect_same_bits(paper_align(views.reference, views.query, options, {threads}), one);
  }
}

TEST(PaperAlign, IsTheSameToTheBitWithATraceAndWithout) {
  const TwoViews views = two_views(4, 0.7, 0.5);
  PaperTrace trace;
  expect_same_bits(paper_align(views.reference, views.query, options_for_test(), {}, &trace),
                   paper_align(views.reference, views.query, options_for_test()));
}

TEST(PaperAlign, TraceIsWhatLedToTheResult) {
  const TwoViews views = two_views(6, 0.7, 0.5);
  PaperTrace trace;
  const PaperAlignment found = paper_align(views.reference, views.query, options_for_test(), {}, &trace);
  ASSERT_TRUE(found.ok()) << found.reason;
  ASSERT_EQ(trace.rotations.size(), 5U);
  ASSERT_GE(trace.best_rotation, 0);
  const RotationMatch& best = trace.rotations.at(static_cast<std::size_t>(trace.best_rotation));
  EXPECT_EQ(found.rotation_rad, best.rotation_rad);
  EXPECT_EQ(found.num_correspondences, best.translation.num_correspondences);
  EXPECT_THAT(found.shape_ref_from_query, HasSameBits(best.target_from_query()));
  EXPECT_THAT(trace.icp.steps.front(), HasSameBits(best.target_from_query()));
  EXPECT_THAT(found.icp_ref_from_query, HasSameBits(trace.icp.steps.back()));
  EXPECT_EQ(found.icp_iterations, trace.icp.iterations);
  for (const RotationMatch& match : trace.rotations) {
    EXPECT_LE(match.overlap.num_points, best.overlap.num_points);
    EXPECT_LE(match.spread.size(), match.lcs.size());
    std::size_t in_segments = 0;
    for (const Correspondences& segment : match.segments) in_segments += segment.size();
    EXPECT_LE(in_segments, match.spread.size());
    EXPECT_LE(match.translation.kept.size(), in_segments);
    EXPECT_GT(match.lcs.size(), 0U);
  }
}

TEST(PaperAlign, CorrespondencesOfTheTraceAreShapePoints) {
  const TwoViews views = two_views(7, 1.0, 0.5);
  PaperTrace trace;
  paper_align(views.reference, views.query, options_for_test(), {}, &trace);
  for (const RotationMatch& match : trace.rotations) {
    for (const Correspondence& c : match.lcs) {
      const ShapePoint& query = views.query.points.at(c.indices.query);
      ASSERT_LT((c.query_m - rotate(query.p_m, match.rotation_rad)).norm(), 1e-12);
      ASSERT_EQ(c.target_m, views.reference.points.at(c.indices.target).p_m);
      ASSERT_LE(angle_between(c.query_tangent_rad, c.target_tangent_rad), 10 * kDegree + 1e-9);
    }
  }
}

TEST(PaperAlign, DecoupledIcpIsLeftOutOnRequest) {
  test::Scanner scanner;
  scanner.num_sweeps = 4;
  scanner.num_beams = 200;
  scanner.view_rad = 100 * kDegree;
  const test::World room = test::cluttered_room(8);
  const Shape reference = test::shape_from(room, {}, scanner);
  const Shape query = test::shape_from(room, {0.3, 0.1, 0.01}, scanner);
  PaperOptions options = options_for_test();
  options.icp.decoupled = false;
  const PaperAlignment without = paper_align(reference, query, options);
  ASSERT_EQ(without.query_from_sweep.size(), 4U);
  for (const Pose2& correction : without.query_from_sweep) EXPECT_THAT(correction, HasSameBits(Pose2{}));
  options.icp.decoupled = true;
  EXPECT_EQ(paper_align(reference, query, options).query_from_sweep.size(), 4U);
}

}  // namespace
}  // namespace shapemap
