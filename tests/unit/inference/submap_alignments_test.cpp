// SPDX-License-Identifier: GPL-3.0-or-later
#include "inference/submap_alignments.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

#include "support/matchers.hpp"
#include "support/random_graph.hpp"

namespace shapemap {
namespace {

using test::IsNearPose;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

using Nodes = std::vector<std::size_t>;

/// Puts each node into a random submap, and returns the nodes of each of `num_submaps`.
std::vector<Nodes> strewn(std::mt19937& rng, std::size_t num_nodes, std::size_t num_submaps) {
  std::uniform_int_distribution<std::size_t> any(0, num_submaps - 1);
  std::vector<Nodes> submaps(num_submaps);
  for (std::size_t n = 0; n < num_nodes; ++n) submaps[any(rng)].push_back(n);
  return submaps;
}

using Steps = std::set<std::tuple<std::size_t, std::size_t, std::size_t>>;

/// Returns the pairs of nodes of two submaps with no node of either between them.
Steps by_all_pairs(const Nodes& of_f, const Nodes& of_g) {
  Steps steps;
  for (const std::size_t f : of_f) {
    for (const std::size_t g : of_g) {
      const auto is_between = [&](std::size_t n) { return n > std::min(f, g) && n < std::max(f, g); };
      if (std::any_of(of_f.begin(), of_f.end(), is_between) || std::any_of(of_g.begin(), of_g.end(), is_between)) {
        continue;
      }
      steps.insert({f, g, std::max(f, g) - std::min(f, g)});
    }
  }
  return steps;
}

TEST(Crossings, ArePairsWithNoNodeOfEitherSubmapBetweenThem) {
  std::mt19937 rng(1);
  for (std::size_t round = 0; round < 200; ++round) {
    const std::vector<Nodes> submaps = strewn(rng, 2 + round % 37, 2 + round % 4);
    const std::vector<Crossing> found = crossings(submaps[0], submaps[1]);
    Steps steps;
    for (const Crossing& crossing : found) steps.insert({crossing.in_f, crossing.in_g, crossing.num_steps});
    EXPECT_EQ(steps, by_all_pairs(submaps[0], submaps[1])) << round;
    EXPECT_EQ(steps.size(), found.size()) << "none twice";
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [](const Crossing& one, const Crossing& other) {
      return std::min(one.in_f, one.in_g) < std::min(other.in_f, other.in_g);
    }));
  }
}

TEST(Crossings, OfASubmapWithoutNodesAreNone) {
  EXPECT_THAT(crossings({}, {1, 2}), IsEmpty());
  EXPECT_THAT(crossings({1, 2}, {}), IsEmpty());
}

constexpr std::size_t kF = 3;  // These are the numbers of two submaps.
constexpr std::size_t kG = 5;

/// Two submaps of 12 nodes each that take turns along the walk, and inter-submap candidates.
struct TwoPieces {
  explicit TwoPieces(unsigned seed) : rng(seed), f_from_g(test::random_pose(rng, 10.0, kPi)) {
    const std::vector<Pose2> walk = test::random_walk(rng, 24);
    for (std::size_t n = 0; n < walk.size(); ++n) {
      const bool in_f = n / 4 % 2 == 0;
      (in_f ? of_f : of_g).push_back(n);
      submap.push_back(in_f ? kF : kG);
      pose.push_back(in_f ? walk[n] : inverse(f_from_g) * walk[n]);
    }
  }

  std::size_t any_of(const Nodes& nodes) {
    return nodes[std::uniform_int_distribution<std::size_t>(0, nodes.size() - 1)(rng)];
  }

  /// Adds a candidate of two random nodes, in either order, that gives the submaps this relative pose.
  std::size_t add(const Pose2& said_f_from_g, double worth, double error = 0.0, double noise = 0.0) {
    const std::size_t i = any_of(of_f);
    const std::size_t j = any_of(of_g);
    const Pose2 i_from_j = inverse(pose[i]) * said_f_from_g * pose[j] * test::random_pose(rng, error, error);
    const Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
    joints.push_back(rng() % 2 == 0 ? EdgeCandidate{i, j, i_from_j, covariance, worth}
                                    : EdgeCandidate{j, i, inverse(i_from_j), covariance, worth});
    noises.push_back(noise);
    return joints.size() - 1;
  }

  double any_worth() { return std::uniform_real_distribution<double>(0.0, 6.0)(rng); }

  /// Returns a candidate with the node of `f` first.
  EdgeCandidate from_f(std::size_t joint) const {
    const EdgeCandidate& c = joints[joint];
    if (submap[c.a] == kF) return c;
    return {c.b, c.a, inverse(c.a_from_b), c.covariance, c.score};
  }
  Pose2 said_by(std::size_t joint) const {
    const EdgeCandidate c = from_f(joint);
    return pose[c.a] * c.a_from_b * inverse(pose[c.b]);
  }

  std::vector<SubmapAlignment> ways(std::size_t piece_first = kF, double trust_cap = 20.0) const {
    Nodes all(joints.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return SubmapAlignments({joints, pose, submap}, trust_cap).ways(piece_first, all, noises);
  }

  std::mt19937 rng;
  Pose2 f_from_g;
  Nodes of_f;
  Nodes of_g;
  std::vector<Pose2> pose;
  Nodes submap;
  std::vector<EdgeCandidate> joints;
  std::vector<double> noises;  ///< of each candidate
};

TEST(SubmapAlignments, ThatAllCandidatesAgreeOnAreOneAndRight) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    TwoPieces submaps(seed);
    for (int k = 0; k < 12; ++k) submaps.add(submaps.f_from_g, 1.0 + submaps.any_worth(), 0.02);
    const std::vector<SubmapAlignment> ways = submaps.ways();
    ASSERT_EQ(ways.size(), 1U) << seed;
    EXPECT_EQ(ways[0].joints.size(), 12U);
    EXPECT_THAT(ways[0].f_from_g, IsNearPose(submaps.f_from_g, 0.20, 1.2 * kDegree)) << seed;
    const std::vector<SubmapAlignment> other_way = submaps.ways(kG);
    ASSERT_EQ(other_way.size(), 1U) << seed;
    EXPECT_THAT(inverse(other_way[0].f_from_g), IsNearPose(submaps.f_from_g, 0.20, 1.2 * kDegree)) << seed;
  }
}

TEST(SubmapAlignments, OfCandidatesWithoutErrorAreExact) {
  TwoPieces submaps(1);
  for (int k = 0; k < 5; ++k) submaps.add(submaps.f_from_g, submaps.any_worth());
  ASSERT_EQ(submaps.ways().size(), 1U);
  EXPECT_THAT(submaps.ways()[0].f_from_g, IsNearPose(submaps.f_from_g, 1e-9, 1e-9));
  TwoPieces lone(2);
  lone.add(lone.f_from_g, 0.0);
  ASSERT_EQ(lone.ways().size(), 1U);
  EXPECT_THAT(lone.ways()[0].f_from_g, IsNearPose(lone.f_from_g, 1e-9, 1e-9));
  EXPECT_THAT(TwoPieces(3).ways(), IsEmpty());
}

TEST(SubmapAlignments, ThatContradictEachOtherAreKeptApartAndTheSurestComesFirst) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    TwoPieces submaps(seed);
    const Pose2 turned = submaps.f_from_g * Pose2{0.0, 0.0, kPi};
    const Pose2 shifted = Pose2{3.0, 0.0, 0.0} * submaps.f_from_g;
    const std::size_t best = submaps.add(turned, 5.0);
    const std::size_t a = submaps.add(submaps.f_from_g, 4.0);
    const std::size_t last = submaps.add(shifted, 1.0);
    const std::size_t b = submaps.add(submaps.f_from_g, 2.0);
    const std::vector<SubmapAlignment> ways = submaps.ways();
    ASSERT_EQ(ways.size(), 3U) << seed;
    EXPECT_THAT(ways[0].joints, ElementsAre(best));
    EXPECT_THAT(ways[1].joints, UnorderedElementsAre(a, b));
    EXPECT_THAT(ways[2].joints, ElementsAre(last));
    EXPECT_THAT(ways[0].f_from_g, IsNearPose(turned, 1e-9, 1e-9));
    EXPECT_THAT(ways[1].f_from_g, IsNearPose(submaps.f_from_g, 1e-9, 1e-9));
    EXPECT_THAT(ways[2].f_from_g, IsNearPose(shifted, 1e-9, 1e-9));
  }
}

std::size_t apart(std::size_t i, std::size_t j) { return std::max(i, j) - std::min(i, j); }

/// Returns whether two candidates put the node of `g` at the same pose in `f`. The tolerance grows with the distance
/// along both submaps, since these may drift.
bool says_the_same(const TwoPieces& submaps, std::size_t seed, std::size_t joint) {
  const EdgeCandidate s = submaps.from_f(seed);
  const EdgeCandidate c = submaps.from_f(joint);
  const Pose2 by_seed = submaps.said_by(seed) * submaps.pose[c.b];
  const Pose2 by_joint = submaps.pose[c.a] * c.a_from_b;
  const auto nodes = static_cast<double>(apart(c.a, s.a) + apart(c.b, s.b));
  return std::hypot(by_seed.x_m - by_joint.x_m, by_seed.y_m - by_joint.y_m) < 0.40 + 0.02 * nodes &&
         angle_between(by_seed.theta_rad, by_joint.theta_rad) < (6 + 0.15 * nodes) * kDegree;
}

/// Returns the sum of the best score of each node, for the submap that has less.
double strength_of(const TwoPieces& submaps, const Nodes& joints, double trust_cap) {
  double sums[2] = {0.0, 0.0};
  for (const bool of_f : {true, false}) {
    for (const std::size_t n : of_f ? submaps.of_f : submaps.of_g) {
      double best = 0.0;
      for (const std::size_t joint : joints) {
        const EdgeCandidate c = submaps.from_f(joint);
        if ((of_f ? c.a : c.b) == n) best = std::max(best, submaps.joints[joint].score);
      }
      sums[of_f ? 0 : 1] += best;
    }
  }
  return std::min({sums[0], sums[1], trust_cap});
}

/// Returns submaps with candidates of four relative poses, some of them near each other, with errors that often are too
/// large.
TwoPieces doubtful_submaps(unsigned seed) {
  TwoPieces submaps(seed);
  const std::vector<Pose2> said{submaps.f_from_g, Pose2{0.35, 0.0, 0.0} * submaps.f_from_g,
                                submaps.f_from_g * Pose2{0.0, 0.1, 7 * kDegree},
                                submaps.f_from_g * Pose2{2.0, 0.0, 2.0}};
  std::uniform_real_distribution<double> noise(-4.0, 4.0);
  for (std::size_t k = 0; k < 10U + 2U * seed; ++k) {
    submaps.add(said[static_cast<std::size_t>(submaps.rng()) % said.size()], submaps.any_worth(), 0.12,
                noise(submaps.rng));
  }
  return submaps;
}

TEST(SubmapAlignments, HaveAllCandidatesThatAgreeWithTheSurestLeft) {
  std::size_t num_ways = 0;
  std::size_t num_shared = 0;
  for (unsigned seed = 1; seed <= 25; ++seed) {
    const TwoPieces submaps = doubtful_submaps(seed);
    std::set<std::size_t> left;
    for (std::size_t k = 0; k < submaps.joints.size(); ++k) left.insert(k);
    const double trust_cap = seed % 2 == 0 ? 20.0 : 8.0;
    for (const SubmapAlignment& way : submaps.ways(kF, trust_cap)) {
      ASSERT_FALSE(left.empty()) << seed;
      const std::size_t surest = *std::max_element(left.begin(), left.end(), [&](std::size_t i, std::size_t j) {
        return submaps.joints[i].score < submaps.joints[j].score;
      });
      Nodes expected;
      for (std::size_t k = 0; k < submaps.joints.size(); ++k) {
        if (!says_the_same(submaps, surest, k)) continue;
        expected.push_back(k);
        num_shared += left.erase(k) == 0 ? 1U : 0U;
      }
      EXPECT_THAT(way.joints, testing::UnorderedElementsAreArray(expected)) << seed;
      EXPECT_NEAR(way.gain, strength_of(submaps, way.joints, trust_cap) + submaps.noises[surest], 1e-9) << seed;
      ++num_ways;
    }
    EXPECT_THAT(left, IsEmpty()) << "each joint is part of a way";
  }
  EXPECT_GT(num_ways, 100U);
  EXPECT_GT(num_shared, 100U) << "some are part of several";
}

/// Returns the sum of the squared errors of translation, and of rotation as the error of a point 2 m away.
double cost_of(const TwoPieces& submaps, const Nodes& joints, const Pose2& f_from_g) {
  double cost = 0.0;
  for (const std::size_t joint : joints) {
    const EdgeCandidate c = submaps.from_f(joint);
    const Pose2 expected = f_from_g * submaps.pose[c.b];
    const Pose2 said = submaps.pose[c.a] * c.a_from_b;
    for (const Point2& point : {Point2(0.0, 0.0), Point2(2.0, 0.0), Point2(-2.0, 0.0)}) {
      const double share = point.x() == 0.0 ? 1.0 : 0.5;
      const Point2 turned = rotate(point, said.theta_rad) - rotate(point, expected.theta_rad);
      const Point2 off = point.x() == 0.0 ? Point2(said.translation() - expected.translation()) : turned;
      cost += share * (submaps.joints[joint].score + 0.1) * off.squaredNorm();
    }
  }
  return cost;
}

TEST(SubmapAlignments, AreWhereTheirCandidatesHaveTheLeastErrors) {
  std::mt19937 rng(9);
  for (unsigned seed = 1; seed <= 25; ++seed) {
    const TwoPieces submaps = doubtful_submaps(seed);
    for (const SubmapAlignment& way : submaps.ways()) {
      const double least = cost_of(submaps, way.joints, way.f_from_g);
      for (int k = 0; k < 30; ++k) {
        const double reach = std::pow(10.0, -1 - k % 4);
        const Pose2 moved = way.f_from_g * test::random_pose(rng, reach, reach);
        EXPECT_LE(least, cost_of(submaps, way.joints, moved) + 1e-9) << seed;
      }
    }
  }
}

TEST(SubmapAlignments, HoldACandidateThatAgreesWithItsSubmap) {
  TwoPieces submaps(4);
  const std::size_t a = submaps.of_f[2];
  const std::size_t b = submaps.of_f[7];
  const auto holds = [&](const Pose2& off) {
    const EdgeCandidate joint{a, b, inverse(submaps.pose[a]) * submaps.pose[b] * off, Eigen::Matrix3d::Identity(), 1.0};
    return SubmapAlignments({submaps.joints, submaps.pose, submaps.submap}, 20.0).holds(joint);
  };
  EXPECT_TRUE(holds({}));
  EXPECT_TRUE(holds({0.0, 0.39, 0.0}));
  EXPECT_FALSE(holds({0.0, 0.41, 0.0}));
  EXPECT_TRUE(holds({0.0, 0.0, -5.9 * kDegree}));
  EXPECT_FALSE(holds({0.0, 0.0, 6.1 * kDegree}));
  EXPECT_FALSE(holds({0.0, 0.0, kPi}));
}

}  // namespace
}  // namespace shapemap
