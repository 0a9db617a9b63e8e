// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/inference/sweep_refinement.hpp"

#include <gmock/gmock.h>

#include "support/matchers.hpp"
#include "support/sweeps_at_stops.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;

/// Scans along a side of the ring and round its corner, whose sweeps are turned by up to 2 degrees.
struct Survey {
  Survey() {
    for (const Scan& scan : stops.log.scans) {
      views.emplace_back();
      for (const Sweep& sweep : scan.sweeps) {
        Scan alone;
        alone.sweeps = {sweep};
        views.back().push_back(std::make_shared<ScanView>(test::view_of(alone)));
      }
    }
  }

  SweepPoses refined(const SweepRefinementOptions& options = {}, int threads = 1) const {
    RunObserver observer;
    return refine_sweeps(views, {start, parts, {}}, {}, options, {threads, observer});
  }

  test::Stops stops = test::stops_on_ring(8, 1.2, 3, 0.02, 2 * kDegree);
  SweepViews views;
  std::vector<Pose2> start = stops.truth;
  std::vector<std::size_t> parts = std::vector<std::size_t>(8, 0);
};

TEST(RefineSweeps, FindsHowEachIsTurned) {
  const Survey survey;
  const std::vector<std::vector<Pose2>> nominal(8, std::vector<Pose2>(test::kTurns));
  const double before_rad = test::heading_rms_rad(survey.stops, survey.start, nominal);
  ASSERT_GT(before_rad, 0.9 * kDegree);
  const SweepPoses found = survey.refined();
  EXPECT_LT(test::heading_rms_rad(survey.stops, found.map_from_node, found.node_from_sweep), 0.35 * before_rad);
}

TEST(RefineSweeps, PutsAScanAtTheMeanOfItsSweeps) {
  const Survey survey;
  const SweepPoses found = survey.refined();
  EXPECT_THAT(found.map_from_node[0], HasSameBits(survey.start[0])) << "the first stays";
  for (std::size_t i = 1; i < found.map_from_node.size(); ++i) {
    double mean_rad = 0.0;
    for (const Pose2& error : found.node_from_sweep[i]) mean_rad += error.theta_rad / test::kTurns;
    EXPECT_NEAR(mean_rad, 0.0, 0.02 * kDegree);
  }
}

/// A start that is off by centimetres and a degree must give the same poses as the right one.
TEST(RefineSweeps, DoesNotDependOnWhereItStarts) {
  Survey survey;
  const SweepPoses wanted = survey.refined();
  std::mt19937 rng(5);
  for (std::size_t i = 1; i < survey.start.size(); ++i) {
    survey.start[i] = survey.start[i] * test::random_pose(rng, 0.05, 1 * kDegree);
  }
  const SweepPoses found = survey.refined();
  for (std::size_t i = 0; i < survey.start.size(); ++i) {
    EXPECT_THAT(found.map_from_node[i], test::IsNearPose(wanted.map_from_node[i], 0.01, 0.1 * kDegree)) << i;
  }
}

TEST(RefineSweeps, WithoutARoundLeavesAllAsItIs) {
  const Survey survey;
  SweepRefinementOptions options;
  options.rounds = 0;
  const SweepPoses found = survey.refined(options);
  for (std::size_t i = 0; i < survey.start.size(); ++i) {
    EXPECT_THAT(found.map_from_node[i], HasSameBits(survey.start[i]));
    for (const Pose2& error : found.node_from_sweep[i]) EXPECT_THAT(error, test::IsNearPose(Pose2{}, 1e-12, 1e-12));
  }
}

TEST(RefineSweeps, DoesNotMatchComponentsThatNothingJoins) {
  Survey survey;
  survey.parts = {0, 0, 0, 0, 4, 4, 4, 4};
  const Pose2 aside{0.10, -0.05, 1 * kDegree};
  for (std::size_t i = 4; i < 8; ++i) survey.start[i] = aside * survey.start[i];
  const SweepPoses found = survey.refined();
  EXPECT_THAT(found.map_from_node[4], HasSameBits(survey.start[4])) << "the first of a piece stays";
  EXPECT_THAT(found.map_from_node[0], HasSameBits(survey.start[0]));
}

TEST(RefineSweeps, IsTheSameToTheBitForAnyNumberOfThreads) {
  const Survey survey;
  SweepRefinementOptions options;
  options.rounds = 2;
  const SweepPoses one = survey.refined(options, 1);
  const SweepPoses three = survey.refined(options, 3);
  for (std::size_t i = 0; i < survey.start.size(); ++i) {
    EXPECT_THAT(three.map_from_node[i], HasSameBits(one.map_from_node[i]));
  }
}

}  // namespace
}  // namespace shapemap
