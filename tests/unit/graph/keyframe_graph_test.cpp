// SPDX-License-Identifier: GPL-3.0-or-later
#include "graph/keyframe_graph.hpp"

#include <gmock/gmock.h>

#include "graph/graph_numbers.hpp"
#include "support/matchers.hpp"
#include "support/ring_laps.hpp"

namespace shapemap {
namespace {

/// Returns a graph of one edge, which the scans do not constrain along the way.
KeyframeGraph sliding_edge() {
  KeyframeGraph graph =
      test::KnownGraph(test::two_laps(), {test::two_laps().truth[0], test::two_laps().truth[1]}).graph;
  LineFit& fit = graph.edges[0].candidates[0].fit;
  fit.information = Eigen::Vector3d(0.0, 400.0, 400.0).asDiagonal();
  fit.partners = 100;
  fit.lever_m = 2.0;
  return graph;
}

double deviation_m(const KeyframeGraph& graph) { return std::sqrt(edge_constraint(graph, 0, 0).covariance(0, 0)); }

TEST(EdgeConstraint, IsLimitedByTheUsualMotionWhereTheScansConstrainLittle) {
  KeyframeGraph graph = sliding_edge();
  const Eigen::Matrix3d by_scans = pose_covariance(graph.edges[0].candidates[0].fit);
  EXPECT_GT(std::sqrt(by_scans(0, 0)), 5.0);
  EXPECT_NEAR(deviation_m(graph), kGraph.steps.usual_slip_m, 0.01) << "nothing is expected";
  EXPECT_NEAR(edge_constraint(graph, 0, 0).covariance(1, 1), by_scans(1, 1), 0.02 * by_scans(1, 1));
  const Pose2 pose = graph.edges[0].candidates[0].ref_from_query;
  graph.keyframes[1].expected = ExpectedPose{pose * Pose2{0.1, 0.0, 2 * kDegree}};
  const Eigen::Matrix3d by_both = edge_constraint(graph, 0, 0).covariance;
  EXPECT_NEAR(deviation_m(graph), kUsualSurprise_m, 0.01);
  EXPECT_NEAR(by_both(1, 1), by_scans(1, 1), 0.02 * by_scans(1, 1));
  EXPECT_NEAR(by_both(2, 2), by_scans(2, 2), 0.02 * by_scans(2, 2));
  EXPECT_TRUE(by_both.isApprox(by_both.transpose()));
  EXPECT_THAT(edge_constraint(graph, 0, 0).a_from_b, test::HasSameBits(pose));
}

/// Otherwise a candidate that jumps would be cheap, because loops could pull it anywhere.
TEST(EdgeConstraint, HasTheSameCovarianceForACandidateThatJumps) {
  KeyframeGraph graph = sliding_edge();
  graph.keyframes[1].expected = ExpectedPose{graph.edges[0].candidates[0].ref_from_query};
  const Eigen::Matrix3d usual = edge_constraint(graph, 0, 0).covariance;
  graph.keyframes[1].expected = ExpectedPose{graph.edges[0].candidates[0].ref_from_query * Pose2{1.2, 0.0, 0.0}};
  EXPECT_EQ(edge_constraint(graph, 0, 0).covariance, usual);
}

TEST(EdgeConstraint, OfACulledEdgeHasTheCovarianceOfTheMap) {
  KeyframeGraph graph = sliding_edge();
  graph.keyframes[1].expected = ExpectedPose{graph.edges[0].candidates[0].ref_from_query};
  graph.edges[0].culled_covariance = Eigen::Matrix3d::Identity();
  EXPECT_EQ(edge_constraint(graph, 0, 0).covariance, Eigen::Matrix3d::Identity());
}

TEST(Surprise, IsByTheMotionPriorWhereNoPoseWasExpected) {
  const MotionPrior prior(std::vector<Pose2>(50, Pose2{1.0, 0.0, 0.0}));
  const Pose2 back{-1.0, 0.0, 0.0};
  Keyframe keyframe;
  EXPECT_GT(prior.surprise(back), 1.0);
  EXPECT_EQ(surprise(keyframe, prior, back), prior.surprise(back));
  keyframe.expected = ExpectedPose{back};
  EXPECT_EQ(surprise(keyframe, prior, back), 0.0);
}

/// Adds a candidate at `off` from the first one, whose score is worse by `behind`.
void add_candidate(const Pose2& off, double behind, KeyframeGraph& graph) {
  OdometryEdge& edge = graph.edges[0];
  MatchCandidate other = edge.candidates[0];
  other.ref_from_query = {other.ref_from_query.x_m + off.x_m, other.ref_from_query.y_m + off.y_m,
                          wrap_angle(other.ref_from_query.theta_rad + off.theta_rad)};
  other.score -= behind;
  edge.candidates.push_back(other);
}

TEST(ChooseCandidates, TakesASlideAlongACorridorForTheSamePlace) {
  KeyframeGraph graph = sliding_edge();
  add_candidate({0.8, 0.0, 0.0}, 0.1, graph);
  add_candidate({-0.8, 0.0, 2 * kDegree}, 0.2, graph);
  choose_candidates(graph);
  EXPECT_EQ(graph.edges[0].choice.candidate, 0U);
  EXPECT_EQ(graph.edges[0].choice.margin, kFullMargin);
  const double alone = edge_probability(graph.edges[0]);
  for (const Pose2& off : {Pose2{4.0, 0.0, 0.0}, Pose2{0.0, 0.8, 0.0}, Pose2{0.0, 0.0, 180 * kDegree}}) {
    KeyframeGraph with = graph;
    add_candidate(off, 1.5, with);
    choose_candidates(with);
    EXPECT_EQ(with.edges[0].choice.candidate, 0U);
    EXPECT_NEAR(with.edges[0].choice.margin, 1.5, 1e-9);
    EXPECT_LT(edge_probability(with.edges[0]), alone);
  }
}

/// All candidates only slide along the corridor. A place that was not found can be as good as the worst of them.
TEST(ChooseCandidates, LimitsTheMarginByTheWorstCandidate) {
  KeyframeGraph graph = sliding_edge();
  add_candidate({0.8, 0.0, 0.0}, 0.1, graph);
  add_candidate({-0.8, 0.0, 0.0}, 2.5, graph);
  graph.edges[0].num_own = 3;
  add_candidate({0.4, 0.0, 0.0}, 9.0, graph);  // This is a multi-reference candidate.
  choose_candidates(graph);
  EXPECT_NEAR(graph.edges[0].choice.margin, 2.5, 1e-9);
}

TEST(ChooseCandidates, TakesASlideForAnotherPlaceWhereTheScansConstrainIt) {
  KeyframeGraph graph = sliding_edge();
  graph.edges[0].candidates[0].fit.information(0, 0) = 400.0;
  add_candidate({0.8, 0.0, 0.0}, 0.1, graph);
  choose_candidates(graph);
  EXPECT_NEAR(graph.edges[0].choice.margin, 0.1, 1e-9);
}

TEST(StatedProbability, IsLowerForScansThatSeeLittle) {
  OdometryEdge edge = sliding_edge().edges[0];
  edge.choice.margin = 3.0;
  const double all_round = stated_probability(edge);
  edge.insufficient_view = 0.25;
  EXPECT_LT(log_odds_of(stated_probability(edge)), log_odds_of(all_round) - 1.0);
}

TEST(MotionPriorOfAGraph, IsLearnedFromCertainAndConstrainedEdges) {
  const test::Laps& laps = test::two_laps();
  KeyframeGraph graph = test::KnownGraph(laps).graph;
  const Pose2 usual = graph.edges[5].candidates[0].ref_from_query;
  const Pose2 unheard{-3.0, 0.0, 180 * kDegree};
  EXPECT_LT(motion_prior(graph).surprise(usual) + 2.0, motion_prior(graph).surprise(unheard));
  for (OdometryEdge& edge : graph.edges) edge.choice.margin = 0.1;
  EXPECT_EQ(motion_prior(graph).surprise(unheard), 0.0) << "none is certain";
  choose_candidates(graph);
  for (OdometryEdge& edge : graph.edges) edge.candidates[0].fit.information(0, 0) = 0.0;
  for (OdometryEdge& edge : graph.edges) edge.candidates[0].fit.information.row(0).setZero();
  for (OdometryEdge& edge : graph.edges) edge.candidates[0].fit.information.col(0).setZero();
  EXPECT_EQ(motion_prior(graph).surprise(unheard), 0.0) << "none is held";
}

}  // namespace
}  // namespace shapemap
