// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/graph/link_revision.hpp"

#include <gmock/gmock.h>

#include "shapemap/align/pose_hypothesis.hpp"
#include "shapemap/graph/loop_closing.hpp"
#include "support/matchers.hpp"
#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

using test::HasSameBits;
using ::testing::Each;
using ::testing::ElementsAre;

const Pose2 kTurnedAway{0.8, -0.6, kPi / 2};
const Pose2 kTooFar{1.4, 0.3, 0.0};

/// A walk round a corner of the ring, in pieces that are right in themselves but not to each other.
struct Torn {
  explicit Torn(const std::vector<std::size_t>& tears, const Pose2& wrong = kTurnedAway) {
    std::size_t first = 0;
    Pose2 moved;
    for (std::size_t n = 0; n < truth.size(); ++n) {
      if (n > 0 && std::find(tears.begin(), tears.end(), n - 1) != tears.end()) {
        first = n;
        moved = poses[n - 1] * inverse(truth[n - 1]) * (truth[n - 1] * true_step(n - 1) * wrong * inverse(truth[n]));
      }
      pieces.push_back(first);
      poses.push_back(moved * truth[n]);
    }
    for (const std::size_t link : tears) {
      doubts.push_back({link, {{inverse(poses[link]) * poses[link + 1], 1.0}, {true_step(link) * kTooFar, 1.5}}});
    }
  }

  Pose2 true_step(std::size_t n) const { return inverse(truth[n]) * truth[n + 1]; }

  RevisedMap revised(double least_certainty = 1.0, int threads = 1) {
    RunObserver nobody;
    return revise_links(views, poses, pieces, doubts, {}, least_certainty, threads, nobody);
  }

  std::vector<Pose2> truth = test::ring_walk(14, 2, 4.0);
  test::Views views = test::views_along(test::ring_world(1), truth);
  std::vector<Pose2> poses;
  std::vector<std::size_t> pieces;
  std::vector<DoubtfulLink> doubts;
};

/// By itself, the right candidate is the worst.
TEST(ReviseLinks, TakesWhatAllScansSayAndNotTheTwoAlone) {
  Torn map({6});
  map.doubts[0].candidates.push_back({map.true_step(6), 0.0});
  const RevisedMap revised = map.revised();
  EXPECT_THAT(revised.choice, ElementsAre(2));
  EXPECT_THAT(revised.piece_of_node, Each(revised.piece_of_node.front()));
  EXPECT_LT(test::worst_off_m(revised.map_from_node, map.truth), 1e-6);
}

TEST(ReviseLinks, RepairsSeveralOnlyOneOfWhichIsRight) {
  Torn map({3, 8});
  map.doubts[0].candidates.push_back({map.true_step(3), 0.0});
  map.doubts[1].candidates[0].a_from_b = map.true_step(8);  // the map is right here
  map.doubts[1].candidates.push_back({map.true_step(8) * kTurnedAway, 1.0});
  const RevisedMap revised = map.revised();
  EXPECT_THAT(revised.choice, ElementsAre(2, 0));
  EXPECT_LT(test::worst_off_m(revised.map_from_node, map.truth), 1e-6);
}

/// The scores are those that the two scans give.
TEST(ReviseLinks, SplitsWhereNoCandidateIsRight) {
  Torn map({6});
  for (DoubtfulLink::Candidate& candidate : map.doubts[0].candidates) {
    candidate.score = hypothesis_at(*map.views[6], *map.views[7], candidate.a_from_b, {}).score;
  }
  const RevisedMap revised = map.revised();
  EXPECT_THAT(revised.choice, ElementsAre(kCut));
  EXPECT_NE(revised.piece_of_node[6], revised.piece_of_node[7]);
  for (std::size_t n = 0; n < map.poses.size(); ++n) {
    EXPECT_THAT(revised.map_from_node[n], HasSameBits(map.poses[n])) << "pieces stay where they are";
  }
}

TEST(ReviseLinks, JoinsNothingWhenNothingIsCertainEnough) {
  Torn map({6});
  map.doubts[0].candidates.push_back({map.true_step(6), 0.0});
  EXPECT_THAT(map.revised(1000.0).choice, ElementsAre(kCut));
}

/// However good both are: the rival's score goes from far behind to far ahead.
TEST(ReviseLinks, SplitsWhereTwoPlacesFitAlike) {
  Torn map({6});
  const Pose2 away = map.doubts[0].candidates[0].a_from_b;
  std::vector<int> choices;
  for (double score = 0.0; score < 400.0; score += 3.0) {
    map.doubts[0].candidates = {{map.true_step(6), 10.0}, {away, score}};
    const int choice = map.revised(3.0).choice[0];
    if (choices.empty() || choices.back() != choice) choices.push_back(choice);
  }
  EXPECT_THAT(choices, ElementsAre(0, kCut, 1));
}

/// Nearly the same twice leaves no doubt about where the piece is.
TEST(ReviseLinks, CountsNoNeighbourAsARival) {
  Torn map({6});
  map.doubts[0].candidates.push_back({map.true_step(6), 0.0});
  map.doubts[0].candidates.push_back({map.true_step(6) * Pose2{0.05, 0.0, 0.5 * kDegree}, 0.0});
  const RevisedMap revised = map.revised();
  ASSERT_GE(revised.choice[0], 2);
  EXPECT_LT(test::worst_off_m(revised.map_from_node, map.truth), 0.15);
}

TEST(ReviseLinks, LeavesAllAsItWasWhenAskedToStop) {
  struct Impatient : RunObserver {
    bool keep_going() override { return false; }
  } impatient;
  Torn map({6});
  map.doubts[0].candidates.push_back({map.true_step(6), 0.0});
  const RevisedMap revised = revise_links(map.views, map.poses, map.pieces, map.doubts, {}, 1.0, 1, impatient);
  EXPECT_THAT(revised.choice, ElementsAre(0));
  EXPECT_LT(test::worst_off_m(revised.map_from_node, map.poses), 1e-6);
}

TEST(ReviseLinks, IsTheSameToTheBitForAnyNumberOfThreads) {
  Torn map({3, 8});
  for (DoubtfulLink& doubt : map.doubts) doubt.candidates.push_back({map.true_step(doubt.link), 0.0});
  const RevisedMap one = map.revised(1.0, 1);
  const RevisedMap three = map.revised(1.0, 3);
  EXPECT_EQ(one.choice, three.choice);
  for (std::size_t n = 0; n < map.poses.size(); ++n)
    EXPECT_THAT(three.map_from_node[n], HasSameBits(one.map_from_node[n]));
}

}  // namespace
}  // namespace shapemap
