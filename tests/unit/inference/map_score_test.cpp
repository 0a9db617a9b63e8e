// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/inference/map_score.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "support/ring_walk.hpp"

namespace shapemap {
namespace {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

Pairs by_all_pairs(const std::vector<Pose2>& poses, double within_m) {
  Pairs pairs;
  for (std::size_t b = 0; b < poses.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (std::hypot(poses[a].x_m - poses[b].x_m, poses[a].y_m - poses[b].y_m) < within_m) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

TEST(NearPairs, AreThoseOfAllPairsThatAreNear) {
  std::mt19937 rng(1);
  for (int round = 0; round < 40; ++round) {
    const double reach_m = 2.0 + 3.0 * round;
    std::vector<Pose2> poses;
    for (int i = 0; i < 120; ++i) poses.push_back(test::random_pose(rng, reach_m, kPi));
    for (const double within_m : {0.7, 5.0, 1000.0}) {
      EXPECT_EQ(near_pairs(poses, within_m), by_all_pairs(poses, within_m)) << round << " " << within_m;
    }
  }
}

TEST(NearPairs, OnTheBordersOfCellsAreNotLost) {
  std::vector<Pose2> poses;
  for (int x = -3; x <= 3; ++x) {
    for (int y = -3; y <= 3; ++y) poses.push_back({2.0 * x, 2.0 * y, 0.0});
  }
  EXPECT_TRUE(near_pairs(poses, 2.0).empty()) << "nearer than, and not as near as";
  EXPECT_EQ(near_pairs(poses, 2.001), by_all_pairs(poses, 2.001));
  EXPECT_EQ(near_pairs(poses, 2.001).size(), 2U * 6U * 7U);
  EXPECT_TRUE(near_pairs({}, 1.0).empty());
}

TEST(MapScore, OfAPairGrowsWithWhatAgreesAndFallsWithWhatIsCrossed) {
  const auto of = [](double agree, double crossed) {
    Visibility seen;
    seen.agree = agree;
    seen.crossed = crossed;
    seen.hidden = 1.0 - agree - crossed;
    return MapScore::of_pair(seen);
  };
  EXPECT_EQ(MapScore::of_pair({}), 0.0);
  EXPECT_NEAR(of(0.0, 0.0), 0.0, 1e-12) << "neither sees what the other does";
  EXPECT_GT(of(0.3, 0.0), 0.0);
  EXPECT_LT(of(0.0, 0.3), 0.0);
  for (double share = 0.0; share < 0.4; share += 0.1) {
    EXPECT_GT(of(share + 0.1, 0.2), of(share, 0.2));
    EXPECT_LT(of(0.2, share + 0.1), of(0.2, share));
  }
}

/// A walk of one lap and a few steps more.
struct Ring {
  std::vector<Pose2> truth = test::ring_walk(test::kRingLap + 8, 2);
  test::Views views = test::views_along(test::ring_world(1), truth);
  MapScore score{views, {}, 1};
};

TEST(MapScore, IsBestForTheTruthAndWorseTheMoreTheMapIsBent) {
  Ring ring;
  double before = ring.score.of(ring.truth);
  EXPECT_GT(before, 0.0);
  for (const double drift_deg : {0.4, 1.2}) {
    const std::vector<Pose2> bent = test::dead_reckoning(test::drifting_edges(ring.truth, drift_deg * kDegree));
    const double value = ring.score.of(bent);
    EXPECT_LT(value, before - 10.0) << drift_deg;
    before = value;
  }
}

/// The odometry of two laps drifts. The score is compared with and without a loop that constrains the second lap.
TEST(MapScore, CountsPairsLittleThatOnlyLongOdometryConstrains) {
  const std::vector<Pose2> truth = test::ring_walk(2 * test::kRingLap, 2);
  const test::Views views = test::views_along(test::ring_world(1), truth);
  const std::vector<Pose2> bent = test::dead_reckoning(test::drifting_edges(truth, 1.2 * kDegree));
  ASSERT_GT(truth.size(), 45U) << "some pairs are far along the chain";
  std::vector<std::size_t> one_each(truth.size());
  std::iota(one_each.begin(), one_each.end(), std::size_t{0});
  MapScore score(views, {}, 1);
  const std::vector<std::size_t> one_ring(truth.size(), 0);
  EXPECT_EQ(score.of(bent, one_ring), score.of(bent));
  EXPECT_GT(score.of(bent, one_each), score.of(bent) + 1.0);
  EXPECT_LE(score.of(truth, one_each), score.of(truth));
}

TEST(MapScore, IsAgainstTwoPlacesOnTopOfEachOther) {
  std::mt19937 rng(2);
  std::vector<Pose2> poses;
  test::Views views;
  for (unsigned place = 1; place <= 2; ++place) {
    const test::World world = test::strange_place(place);
    for (unsigned k = 0; k < 6; ++k) {
      poses.push_back(test::random_pose(rng, 0.5, kPi));
      views.push_back(std::make_shared<ScanView>(test::view_from(world, poses.back(), test::full_circle(), k)));
    }
  }
  std::vector<Pose2> apart = poses;
  for (std::size_t n = 6; n < 12; ++n) apart[n].x_m += 1000.0;
  MapScore score(views, {}, 1);
  EXPECT_GT(score.of(apart), score.of(poses) + 10.0);
}

TEST(MapScore, IsNoneWhereNoTwoStretchesMeet) {
  std::vector<Pose2> straight;
  for (int k = 0; k < 6; ++k) straight.push_back({7.0 * k, 0.0, 0.0});
  MapScore score(test::views_along(test::ring_world(1), test::ring_walk(6, 1)), {}, 1);
  EXPECT_EQ(score.of(straight), 0.0);
  EXPECT_EQ(MapScore({}, {}, 1).of({}), 0.0);
}

/// The score depends on relative poses alone.
TEST(MapScore, DoesNotDependOnTheFrameOfTheMap) {
  Ring ring;
  std::vector<Pose2> elsewhere = ring.truth;
  for (Pose2& pose : elsewhere) pose = Pose2{3.0, -40.0, 2.0} * pose;
  const double value = MapScore(ring.views, {}, 1).of(ring.truth);
  EXPECT_NEAR(MapScore(ring.views, {}, 1).of(elsewhere), value, 1e-3 * value);
}

TEST(MapScore, ThatRemembersGivesWhatAFreshOneGives) {
  Ring ring;
  const std::vector<Pose2> bent = test::dead_reckoning(test::drifting_edges(ring.truth, 1.0 * kDegree), ring.truth[0]);
  const auto fresh = [&](const std::vector<Pose2>& poses) { return MapScore(ring.views, {}, 1).of(poses); };
  const double of_truth = ring.score.of(ring.truth);
  const double of_bent = ring.score.of(bent);
  EXPECT_EQ(of_truth, fresh(ring.truth));
  EXPECT_NEAR(of_bent, fresh(bent), 0.05 * std::abs(of_truth - of_bent));
  EXPECT_NEAR(ring.score.of(ring.truth), of_truth, 0.05 * std::abs(of_truth - of_bent));
}

/// Each further lap must count less. Otherwise a map would gain by laying many places on each other.
TEST(MapScore, GrowsByNoMoreThanOneForEachNodeHoweverOftenItsPlaceIsPassed) {
  double before = 0.0;
  for (const std::size_t laps : {1U, 2U, 4U}) {
    const std::vector<Pose2> truth = test::ring_walk(laps * test::kRingLap, 2);
    const double now = MapScore(test::views_along(test::ring_world(1), truth), {}, 1).of(truth);
    if (laps > 1) {
      const double of_stretches = now - static_cast<double>(laps) * before;
      EXPECT_GT(of_stretches, 0.0) << laps;
      EXPECT_LT(of_stretches, 1.2 * static_cast<double>(truth.size())) << laps;
    } else {
      before = now;
    }
  }
}

/// Many small steps add up to a large one, after which the score must compare the remembered pairs again.
TEST(MapScore, ThatRemembersDoesNotFallBehind) {
  Ring ring;
  std::vector<Pose2> creeping = ring.truth;
  const double at_first = ring.score.of(creeping);
  for (int step = 0; step < 60; ++step) {
    for (std::size_t n = test::kRingLap; n < creeping.size(); ++n) creeping[n].y_m += 0.01;
    ring.score.of(creeping);
  }
  const double at_last = ring.score.of(creeping);
  EXPECT_LT(at_last, at_first - 20.0);
  EXPECT_NEAR(at_last, MapScore(ring.views, {}, 1).of(creeping), 0.1 * (at_first - at_last));
}

TEST(MapScore, IsTheSameToTheBitForAnyNumberOfThreads) {
  Ring ring;
  EXPECT_EQ(MapScore(ring.views, {}, 3).of(ring.truth), ring.score.of(ring.truth));
}

/// Two submaps of a map, each in a frame of its own.
struct TwoPieces {
  TwoPieces(const std::vector<Pose2>& truth, const std::vector<std::size_t>& of_f, std::vector<std::size_t> of_g)
      : f(of_f), g(std::move(of_g)), pose(truth) {
    for (const std::size_t n : g) pose[n] = inverse(f_from_g) * pose[n];
  }

  double between(MapScore& score, const Pose2& moved = {}) const { return score.between(pose, f, g, moved * f_from_g); }

  /// Returns the score of a map with the submaps at these poses, minus that of a map with both far from each other.
  double by_whole_maps(const test::Views& views, const Pose2& moved = {}) const {
    std::vector<Pose2> together = pose;
    std::vector<Pose2> apart = pose;
    for (const std::size_t n : g) together[n] = moved * f_from_g * pose[n];
    for (const std::size_t n : g) apart[n].x_m += 1000.0;
    for (std::size_t n = 0; n < pose.size(); ++n) {  // All other nodes are far from both.
      if (std::count(f.begin(), f.end(), n) + std::count(g.begin(), g.end(), n) > 0) continue;
      together[n] = apart[n] = {0.0, 1e4 * static_cast<double>(n + 1), 0.0};
    }
    return MapScore(views, {}, 1).of(together) - MapScore(views, {}, 1).of(apart);
  }

  Pose2 f_from_g{3.0, -40.0, 2.0};
  std::vector<std::size_t> f;
  std::vector<std::size_t> g;
  std::vector<Pose2> pose;
};

/// Returns the nodes from `first` to `last` - 1 for which `wanted` is true.
template <class Wanted>
std::vector<std::size_t> nodes(std::size_t first, std::size_t last, Wanted wanted) {
  std::vector<std::size_t> chosen;
  for (std::size_t n = first; n < last; ++n) {
    if (wanted(n)) chosen.push_back(n);
  }
  return chosen;
}
const auto kAll = [](std::size_t) { return true; };

/// The submaps are so short that no node gains by others of its own submap.
TEST(MapEvidenceBetween, IsWhatAWholeMapGainsByThePairsOfBothSubmaps) {
  Ring ring;
  const auto even_threes = [](std::size_t n) { return n / 3 % 2 == 0; };
  const auto odd_threes = [](std::size_t n) { return n / 3 % 2 == 1; };
  const std::vector<TwoPieces> cases{{ring.truth, nodes(0, 8, kAll), nodes(46, 54, kAll)},
                                     {ring.truth, nodes(46, 54, kAll), nodes(0, 8, kAll)},
                                     {ring.truth, nodes(0, 8, even_threes), nodes(0, 8, odd_threes)},
                                     {ring.truth, nodes(20, 21, kAll), nodes(22, 30, kAll)}};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const double right = cases[k].by_whole_maps(ring.views);
    EXPECT_GT(right, 2.0) << k;
    EXPECT_NEAR(cases[k].between(ring.score), right, 1e-3 * right) << k;
    std::mt19937 rng(5);
    for (int round = 0; round < 4; ++round) {
      const Pose2 moved = test::random_pose(rng, 2.0, 0.5);
      const double expected = cases[k].by_whole_maps(ring.views, moved);
      MapScore fresh(ring.views, {}, 1);
      EXPECT_NEAR(cases[k].between(fresh, moved), expected, 1e-3 * std::abs(expected) + 1e-3) << k;
    }
  }
}

TEST(MapEvidenceBetween, DoesNotDependOnWhichSubmapComesFirst) {
  Ring ring;
  const TwoPieces submaps(ring.truth, nodes(0, 12, kAll), nodes(46, 58, kAll));
  const double one = submaps.between(ring.score);
  const double other =
      MapScore(ring.views, {}, 1).between(submaps.pose, submaps.g, submaps.f, inverse(submaps.f_from_g));
  EXPECT_NEAR(one, other, 1e-3 * one);
}

/// Returns the evidence from all pairs one by one. The evidence of a pair for the map is recovered from its score, in
/// which both nodes gain half of it, and at most 1 each.
double by_each_pair(const TwoPieces& submaps, const test::Views& views, const Pose2& moved) {
  MapScore score(views, {}, 1);
  double sum = 0.0;
  std::map<std::size_t, double> gained;
  for (const std::size_t i : submaps.f) {
    for (const std::size_t j : submaps.g) {
      const double left = score.between(submaps.pose, {i}, {j}, moved * submaps.f_from_g);
      const bool is_of_one_stretch = std::max(i, j) - std::min(i, j) < 8;
      if (left < 0.0 || is_of_one_stretch) {
        sum += left;
        continue;
      }
      const double half = -std::log(1.0 - 0.5 * left);
      gained[i] += half;
      gained[j] += half;
    }
  }
  for (const auto& [unused, gain] : gained) sum += 1.0 - std::exp(-gain);
  return sum;
}

/// The walk is so long that only a sample of the pairs is compared.
TEST(MapEvidenceBetween, OfManyPairsIsEstimatedWell) {
  const std::vector<Pose2> truth = test::ring_walk(160, 2);
  const test::Views views = test::views_along(test::ring_world(1), truth);
  const TwoPieces submaps(truth, nodes(0, 100, kAll), nodes(100, 160, kAll));
  for (const Pose2& moved : {Pose2{}, Pose2{1.0, -1.0, 0.2}}) {
    MapScore score(views, {}, 1);
    const double expected = by_each_pair(submaps, views, moved);
    EXPECT_NEAR(submaps.between(score, moved), expected, 0.15 * std::abs(expected));
    MapScore by_three(views, {}, 3);
    EXPECT_EQ(submaps.between(by_three, moved), submaps.between(score, moved)) << "to the bit";
  }
}

TEST(MapEvidenceBetween, IsNoneForSubmapsThatDoNotMeet) {
  Ring ring;
  const TwoPieces submaps(ring.truth, nodes(0, 12, kAll), nodes(46, 58, kAll));
  EXPECT_EQ(submaps.between(ring.score, {100.0, 0.0, 0.0}), 0.0);
  EXPECT_EQ(ring.score.between(ring.truth, {}, {1, 2}, {}), 0.0);
  EXPECT_EQ(ring.score.between(ring.truth, {3}, {4}, {}), 0.0) << "neighbours tell nothing new";
}

}  // namespace
}  // namespace shapemap
