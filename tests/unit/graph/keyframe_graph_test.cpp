// SPDX-License-Identifier: GPL-3.0-or-later
#include "graph/keyframe_graph.hpp"

#include <gmock/gmock.h>

#include "support/matchers.hpp"
#include "support/ring_laps.hpp"

namespace shapemap {
namespace {

/// A link that the scans do not hold along the way.
KeyframeChain sliding_link() {
  KeyframeChain chain =
      test::KnownChain(test::two_laps(), {test::two_laps().truth[0], test::two_laps().truth[1]}).chain;
  LineFit& fit = chain.links[0].hypotheses[0].fit;
  fit.information = Eigen::Vector3d(0.0, 400.0, 400.0).asDiagonal();
  fit.partners = 100;
  fit.lever_m = 2.0;
  return chain;
}

double deviation_m(const KeyframeChain& chain) { return std::sqrt(link_constraint(chain, 0, 0).covariance(0, 0)); }

TEST(LinkConstraint, IsHeldByTheUsualMotionWhereTheScansSayLittle) {
  KeyframeChain chain = sliding_link();
  const Eigen::Matrix3d by_scans = pose_covariance(chain.links[0].hypotheses[0].fit);
  EXPECT_GT(std::sqrt(by_scans(0, 0)), 5.0);
  EXPECT_NEAR(deviation_m(chain), kUsualSlip_m, 0.01) << "nothing is expected";
  EXPECT_NEAR(link_constraint(chain, 0, 0).covariance(1, 1), by_scans(1, 1), 0.02 * by_scans(1, 1));
  const Pose2 pose = chain.links[0].hypotheses[0].ref_from_query;
  chain.keyframes[1].expected = ExpectedPose{pose * Pose2{0.1, 0.0, 2 * kDegree}};
  const Eigen::Matrix3d by_both = link_constraint(chain, 0, 0).covariance;
  EXPECT_NEAR(deviation_m(chain), kUsualSurprise_m, 0.01);
  EXPECT_NEAR(by_both(1, 1), by_scans(1, 1), 0.02 * by_scans(1, 1));
  EXPECT_NEAR(by_both(2, 2), by_scans(2, 2), 0.02 * by_scans(2, 2));
  EXPECT_TRUE(by_both.isApprox(by_both.transpose()));
  EXPECT_THAT(link_constraint(chain, 0, 0).a_from_b, test::HasSameBits(pose));
}

/// Else a jump would be the cheaper alternative: it could be pulled wherever loops want it.
TEST(LinkConstraint, IsHeldAlikeWhereAnAlternativeIsAJump) {
  KeyframeChain chain = sliding_link();
  chain.keyframes[1].expected = ExpectedPose{chain.links[0].hypotheses[0].ref_from_query};
  const Eigen::Matrix3d usual = link_constraint(chain, 0, 0).covariance;
  chain.keyframes[1].expected = ExpectedPose{chain.links[0].hypotheses[0].ref_from_query * Pose2{1.2, 0.0, 0.0}};
  EXPECT_EQ(link_constraint(chain, 0, 0).covariance, usual);
}

TEST(LinkConstraint, OfASettledMapIsWhatTheMapSays) {
  KeyframeChain chain = sliding_link();
  chain.keyframes[1].expected = ExpectedPose{chain.links[0].hypotheses[0].ref_from_query};
  chain.links[0].settled_covariance = Eigen::Matrix3d::Identity();
  EXPECT_EQ(link_constraint(chain, 0, 0).covariance, Eigen::Matrix3d::Identity());
}

TEST(Surprise, IsByHabitWhereNothingWasToBeExpected) {
  const MotionHabit habit(std::vector<Pose2>(50, Pose2{1.0, 0.0, 0.0}));
  const Pose2 back{-1.0, 0.0, 0.0};
  Keyframe keyframe;
  EXPECT_GT(habit.surprise(back), 1.0);
  EXPECT_EQ(surprise(keyframe, habit, back), habit.surprise(back));
  keyframe.expected = ExpectedPose{back};
  EXPECT_EQ(surprise(keyframe, habit, back), 0.0);
}

/// `off` the first, and a little worse.
void add_alternative(const Pose2& off, double behind, KeyframeChain& chain) {
  KeyframeLink& link = chain.links[0];
  PoseHypothesis other = link.hypotheses[0];
  other.ref_from_query = {other.ref_from_query.x_m + off.x_m, other.ref_from_query.y_m + off.y_m,
                          wrap_angle(other.ref_from_query.theta_rad + off.theta_rad)};
  other.score -= behind;
  link.hypotheses.push_back(other);
}

TEST(ChooseHypotheses, WhatSlidesAlongACorridorIsNoOtherPlace) {
  KeyframeChain chain = sliding_link();
  add_alternative({0.8, 0.0, 0.0}, 0.1, chain);
  add_alternative({-0.8, 0.0, 2 * kDegree}, 0.2, chain);
  choose_hypotheses(chain);
  EXPECT_EQ(chain.links[0].choice.alternative, 0U);
  EXPECT_EQ(chain.links[0].choice.margin, kFullMargin);
  const double alone = link_probability(chain.links[0]);
  for (const Pose2& off : {Pose2{4.0, 0.0, 0.0}, Pose2{0.0, 0.8, 0.0}, Pose2{0.0, 0.0, 180 * kDegree}}) {
    KeyframeChain with = chain;
    add_alternative(off, 1.5, with);
    choose_hypotheses(with);
    EXPECT_EQ(with.links[0].choice.alternative, 0U);
    EXPECT_NEAR(with.links[0].choice.margin, 1.5, 1e-9);
    EXPECT_LT(link_probability(with.links[0]), alone);
  }
}

/// All that were found slide along the corridor: of another place it is only known that it is no better than these.
TEST(ChooseHypotheses, WhatWasNotFoundMayBeAsGoodAsTheWorstThatWas) {
  KeyframeChain chain = sliding_link();
  add_alternative({0.8, 0.0, 0.0}, 0.1, chain);
  add_alternative({-0.8, 0.0, 0.0}, 2.5, chain);
  chain.links[0].num_own = 3;
  add_alternative({0.4, 0.0, 0.0}, 9.0, chain);  // by way of a scan further back
  choose_hypotheses(chain);
  EXPECT_NEAR(chain.links[0].choice.margin, 2.5, 1e-9);
}

TEST(ChooseHypotheses, WhereScansHoldThePlaceSlidingIsOne) {
  KeyframeChain chain = sliding_link();
  chain.links[0].hypotheses[0].fit.information(0, 0) = 400.0;
  add_alternative({0.8, 0.0, 0.0}, 0.1, chain);
  choose_hypotheses(chain);
  EXPECT_NEAR(chain.links[0].choice.margin, 0.1, 1e-9);
}

TEST(StatedProbability, IsLessOfScansThatSeeLittle) {
  KeyframeLink link = sliding_link().links[0];
  link.choice.margin = 3.0;
  const double all_round = stated_probability(link);
  link.view_shortfall = 0.25;
  EXPECT_LT(log_odds_of(stated_probability(link)), log_odds_of(all_round) - 1.0);
}

TEST(MotionHabitOfAChain, IsThatOfLinksThatAreCertainAndHeld) {
  const test::Laps& laps = test::two_laps();
  KeyframeChain chain = test::KnownChain(laps).chain;
  const Pose2 usual = chain.links[5].hypotheses[0].ref_from_query;
  const Pose2 unheard{-3.0, 0.0, 180 * kDegree};
  EXPECT_LT(motion_habit(chain).surprise(usual) + 2.0, motion_habit(chain).surprise(unheard));
  for (KeyframeLink& link : chain.links) link.choice.margin = 0.1;
  EXPECT_EQ(motion_habit(chain).surprise(unheard), 0.0) << "none is certain";
  choose_hypotheses(chain);
  for (KeyframeLink& link : chain.links) link.hypotheses[0].fit.information(0, 0) = 0.0;
  for (KeyframeLink& link : chain.links) link.hypotheses[0].fit.information.row(0).setZero();
  for (KeyframeLink& link : chain.links) link.hypotheses[0].fit.information.col(0).setZero();
  EXPECT_EQ(motion_habit(chain).surprise(unheard), 0.0) << "none is held";
}

}  // namespace
}  // namespace shapemap
