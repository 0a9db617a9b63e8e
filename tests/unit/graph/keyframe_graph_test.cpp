// SPDX-License-Identifier: GPL-3.0-or-later
#include "graph/keyframe_graph.hpp"

#include <gmock/gmock.h>

#include "support/matchers.hpp"
#include "support/ring_laps.hpp"

namespace shapemap {
namespace {

/// A link that the scans do not hold along the way.
KeyframeGraph sliding_link() {
  KeyframeGraph chain =
      test::KnownChain(test::two_laps(), {test::two_laps().truth[0], test::two_laps().truth[1]}).chain;
  LineFit& fit = chain.edges[0].candidates[0].fit;
  fit.information = Eigen::Vector3d(0.0, 400.0, 400.0).asDiagonal();
  fit.partners = 100;
  fit.lever_m = 2.0;
  return chain;
}

double deviation_m(const KeyframeGraph& chain) { return std::sqrt(edge_constraint(chain, 0, 0).covariance(0, 0)); }

TEST(LinkConstraint, IsHeldByTheUsualMotionWhereTheScansSayLittle) {
  KeyframeGraph chain = sliding_link();
  const Eigen::Matrix3d by_scans = pose_covariance(chain.edges[0].candidates[0].fit);
  EXPECT_GT(std::sqrt(by_scans(0, 0)), 5.0);
  EXPECT_NEAR(deviation_m(chain), kUsualSlip_m, 0.01) << "nothing is expected";
  EXPECT_NEAR(edge_constraint(chain, 0, 0).covariance(1, 1), by_scans(1, 1), 0.02 * by_scans(1, 1));
  const Pose2 pose = chain.edges[0].candidates[0].ref_from_query;
  chain.keyframes[1].expected = ExpectedPose{pose * Pose2{0.1, 0.0, 2 * kDegree}};
  const Eigen::Matrix3d by_both = edge_constraint(chain, 0, 0).covariance;
  EXPECT_NEAR(deviation_m(chain), kUsualSurprise_m, 0.01);
  EXPECT_NEAR(by_both(1, 1), by_scans(1, 1), 0.02 * by_scans(1, 1));
  EXPECT_NEAR(by_both(2, 2), by_scans(2, 2), 0.02 * by_scans(2, 2));
  EXPECT_TRUE(by_both.isApprox(by_both.transpose()));
  EXPECT_THAT(edge_constraint(chain, 0, 0).a_from_b, test::HasSameBits(pose));
}

/// Else a jump would be the cheaper alternative: it could be pulled wherever loops want it.
TEST(LinkConstraint, IsHeldAlikeWhereAnAlternativeIsAJump) {
  KeyframeGraph chain = sliding_link();
  chain.keyframes[1].expected = ExpectedPose{chain.edges[0].candidates[0].ref_from_query};
  const Eigen::Matrix3d usual = edge_constraint(chain, 0, 0).covariance;
  chain.keyframes[1].expected = ExpectedPose{chain.edges[0].candidates[0].ref_from_query * Pose2{1.2, 0.0, 0.0}};
  EXPECT_EQ(edge_constraint(chain, 0, 0).covariance, usual);
}

TEST(LinkConstraint, OfASettledMapIsWhatTheMapSays) {
  KeyframeGraph chain = sliding_link();
  chain.keyframes[1].expected = ExpectedPose{chain.edges[0].candidates[0].ref_from_query};
  chain.edges[0].culled_covariance = Eigen::Matrix3d::Identity();
  EXPECT_EQ(edge_constraint(chain, 0, 0).covariance, Eigen::Matrix3d::Identity());
}

TEST(Surprise, IsByHabitWhereNothingWasToBeExpected) {
  const MotionPrior prior(std::vector<Pose2>(50, Pose2{1.0, 0.0, 0.0}));
  const Pose2 back{-1.0, 0.0, 0.0};
  Keyframe keyframe;
  EXPECT_GT(prior.surprise(back), 1.0);
  EXPECT_EQ(surprise(keyframe, prior, back), prior.surprise(back));
  keyframe.expected = ExpectedPose{back};
  EXPECT_EQ(surprise(keyframe, prior, back), 0.0);
}

/// `off` the first, and a little worse.
void add_alternative(const Pose2& off, double behind, KeyframeGraph& chain) {
  OdometryEdge& link = chain.edges[0];
  MatchCandidate other = link.candidates[0];
  other.ref_from_query = {other.ref_from_query.x_m + off.x_m, other.ref_from_query.y_m + off.y_m,
                          wrap_angle(other.ref_from_query.theta_rad + off.theta_rad)};
  other.score -= behind;
  link.candidates.push_back(other);
}

TEST(ChooseHypotheses, WhatSlidesAlongACorridorIsNoOtherPlace) {
  KeyframeGraph chain = sliding_link();
  add_alternative({0.8, 0.0, 0.0}, 0.1, chain);
  add_alternative({-0.8, 0.0, 2 * kDegree}, 0.2, chain);
  choose_candidates(chain);
  EXPECT_EQ(chain.edges[0].choice.candidate, 0U);
  EXPECT_EQ(chain.edges[0].choice.margin, kFullMargin);
  const double alone = edge_probability(chain.edges[0]);
  for (const Pose2& off : {Pose2{4.0, 0.0, 0.0}, Pose2{0.0, 0.8, 0.0}, Pose2{0.0, 0.0, 180 * kDegree}}) {
    KeyframeGraph with = chain;
    add_alternative(off, 1.5, with);
    choose_candidates(with);
    EXPECT_EQ(with.edges[0].choice.candidate, 0U);
    EXPECT_NEAR(with.edges[0].choice.margin, 1.5, 1e-9);
    EXPECT_LT(edge_probability(with.edges[0]), alone);
  }
}

/// All that were found slide along the corridor: of another place it is only known that it is no better than these.
TEST(ChooseHypotheses, WhatWasNotFoundMayBeAsGoodAsTheWorstThatWas) {
  KeyframeGraph chain = sliding_link();
  add_alternative({0.8, 0.0, 0.0}, 0.1, chain);
  add_alternative({-0.8, 0.0, 0.0}, 2.5, chain);
  chain.edges[0].num_own = 3;
  add_alternative({0.4, 0.0, 0.0}, 9.0, chain);  // by way of a scan further back
  choose_candidates(chain);
  EXPECT_NEAR(chain.edges[0].choice.margin, 2.5, 1e-9);
}

TEST(ChooseHypotheses, WhereScansHoldThePlaceSlidingIsOne) {
  KeyframeGraph chain = sliding_link();
  chain.edges[0].candidates[0].fit.information(0, 0) = 400.0;
  add_alternative({0.8, 0.0, 0.0}, 0.1, chain);
  choose_candidates(chain);
  EXPECT_NEAR(chain.edges[0].choice.margin, 0.1, 1e-9);
}

TEST(StatedProbability, IsLessOfScansThatSeeLittle) {
  OdometryEdge link = sliding_link().edges[0];
  link.choice.margin = 3.0;
  const double all_round = stated_probability(link);
  link.insufficient_view = 0.25;
  EXPECT_LT(log_odds_of(stated_probability(link)), log_odds_of(all_round) - 1.0);
}

TEST(MotionHabitOfAChain, IsThatOfLinksThatAreCertainAndHeld) {
  const test::Laps& laps = test::two_laps();
  KeyframeGraph chain = test::KnownChain(laps).chain;
  const Pose2 usual = chain.edges[5].candidates[0].ref_from_query;
  const Pose2 unheard{-3.0, 0.0, 180 * kDegree};
  EXPECT_LT(motion_prior(chain).surprise(usual) + 2.0, motion_prior(chain).surprise(unheard));
  for (OdometryEdge& link : chain.edges) link.choice.margin = 0.1;
  EXPECT_EQ(motion_prior(chain).surprise(unheard), 0.0) << "none is certain";
  choose_candidates(chain);
  for (OdometryEdge& link : chain.edges) link.candidates[0].fit.information(0, 0) = 0.0;
  for (OdometryEdge& link : chain.edges) link.candidates[0].fit.information.row(0).setZero();
  for (OdometryEdge& link : chain.edges) link.candidates[0].fit.information.col(0).setZero();
  EXPECT_EQ(motion_prior(chain).surprise(unheard), 0.0) << "none is held";
}

}  // namespace
}  // namespace shapemap
