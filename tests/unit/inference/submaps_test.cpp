// SPDX-License-Identifier: GPL-3.0-or-later
#include "inference/submaps.hpp"

#include <gmock/gmock.h>

#include <random>

#include "support/matchers.hpp"

namespace shapemap {
namespace {

using ::testing::ElementsAre;

Pose2 any_pose(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  return {uniform(random), uniform(random), uniform(random)};
}

/// Returns submaps of which one has nodes 2 and 3, and another all the rest.
Submaps away_and_back(std::mt19937& random) {
  std::vector<Pose2> poses;
  for (int n = 0; n < 6; ++n) poses.push_back(any_pose(random));
  return {poses, {0, 0, 2, 2, 0, 0}};
}

TEST(Submaps, JoinsTheWholeLaterSubmap) {
  std::mt19937 random(1);
  Submaps submaps = away_and_back(random);
  const std::vector<Pose2> before = submaps.map_from_node();
  const Pose2 within = submaps.step(2);
  const Pose2 a_from_b = any_pose(random);
  submaps.join(1, a_from_b);
  EXPECT_THAT(submaps.submap_of_node(), ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_THAT(submaps.step(1), test::IsNearPose(a_from_b, 1e-9, 1e-9));
  EXPECT_THAT(submaps.step(2), test::IsNearPose(within, 1e-9, 1e-9)) << "no piece bends";
  EXPECT_THAT(submaps.map_from_node()[5], test::IsNearPose(before[5], 1e-9, 1e-9));
}

TEST(Submaps, TellsWhichEdgesJoinTheSameTwo) {
  std::mt19937 random(2);
  Submaps submaps = away_and_back(random);
  EXPECT_TRUE(submaps.are_parallel(1, 3));
  EXPECT_TRUE(submaps.are_parallel(3, 1));
  EXPECT_FALSE(submaps.are_parallel(0, 4)) << "both are within a piece";
  EXPECT_FALSE(submaps.are_parallel(1, 2));
  EXPECT_FALSE(submaps.are_parallel(2, 1));
  submaps.join(1, {});
  EXPECT_FALSE(submaps.are_parallel(1, 3)) << "nothing is left to join";
  EXPECT_TRUE(submaps.is_joined(3));
}

/// Both parallel edges must give the submaps the same relative pose, in either direction.
TEST(Submaps, CarriesThePoseOfOneEdgeToTheOther) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const Submaps apart = away_and_back(random);
    const Pose2 a_from_b = any_pose(random);
    for (const auto& [edge, parallel] : {std::pair<std::size_t, std::size_t>{1, 3}, {3, 1}}) {
      Submaps joined = apart;
      joined.join(parallel, a_from_b);
      EXPECT_THAT(apart.carried_to(edge, parallel, a_from_b), test::IsNearPose(joined.step(edge), 1e-9, 1e-9));
    }
  }
}

}  // namespace
}  // namespace shapemap
