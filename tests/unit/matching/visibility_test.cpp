// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/visibility.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "support/views.hpp"

namespace shapemap {
namespace {

/// Returns a view without points whose sensor is at the origin: its beams are 45 degrees wide and end at `ranges_m`, on
/// surfaces that face the sensor.
ScanView seer(const std::vector<double>& ranges_m, double first_bearing_rad = 0.0) {
  ScanView view;
  RangeImage image;
  image.first_bearing_rad = first_bearing_rad;
  image.step_rad = kPi / 4;
  for (std::size_t k = 0; k < ranges_m.size(); ++k) {
    const Point2 away = rotate({1.0, 0.0}, first_bearing_rad + static_cast<double>(k) * image.step_rad);
    image.beams.push_back({ranges_m[k], ranges_m[k] * away, -away, 0.05});
  }
  view.images.push_back(image);
  return view;
}

ScanView all_around(double range_m) { return seer(std::vector<double>(8, range_m)); }

/// Adds a point to a view. The direction of a wall is counterclockwise about the sensor that sees it.
void add_point(ScanView& view, const Point2& p_m, double direction_rad, double weight = 1.0,
               double cross_weight = 0.0) {
  view.points.push_back({p_m, direction_rad, 0});
  view.directions.emplace_back(std::cos(direction_rad), std::sin(direction_rad));
  view.weights.push_back(weight);
  view.cross_weights.push_back(cross_weight);
}

Visibility of_point(const ScanView& seer, const Point2& p_m, double direction_rad, double slack = 1.0) {
  ScanView seen;
  add_point(seen, p_m, direction_rad);
  return visibility(seer, seen, {}, {0.10, 25 * kDegree, 0.20}, {slack, 1});
}

TEST(Visibility, OfAPointOnTheSurfaceThatWasSeenThereAgrees) {
  for (const double off_m : {-0.09, 0.0, 0.09}) {
    const Visibility v = of_point(all_around(2.0), {2.0 + off_m, 0.0}, kPi / 2);
    EXPECT_EQ(v.agree, 1.0) << off_m;
    EXPECT_EQ(v.total(), 1.0);
  }
}

TEST(Visibility, AgreementTakesTheSameTangentTheSameWay) {
  for (const double off_deg : {-24.0, 24.0}) {
    EXPECT_EQ(of_point(all_around(2.0), {2.0, 0.0}, kPi / 2 + off_deg * kDegree).agree, 1.0);
  }
  for (const double off_deg : {-26.0, 26.0, 180.0}) {
    const Visibility v = of_point(all_around(2.0), {2.0, 0.0}, kPi / 2 + off_deg * kDegree);
    EXPECT_EQ(v.unclear, 1.0) << off_deg;
  }
}

TEST(Visibility, OfAPointThatBeamsWentThroughIsCrossed) {
  const Visibility v = of_point(all_around(2.0), {1.0, 0.1}, 0.3);
  EXPECT_EQ(v.crossed, 1.0);
  EXPECT_EQ(v.total(), 1.0);
}

TEST(Visibility, IsCrossedOnlyByAllOfTheBeamsAbout) {
  ScanView one_shorter = seer({0.9, 2.0, 2.0}, -kPi / 4);
  EXPECT_EQ(of_point(one_shorter, {1.2, 0.0}, 0.3).crossed, 0.0);
  EXPECT_EQ(of_point(one_shorter, {1.2, 0.0}, 0.3).hidden, 1.0);
  ScanView one_without_return = seer({2.0, 2.0, 0.0}, -kPi / 4);
  EXPECT_EQ(of_point(one_without_return, {1.2, 0.0}, 0.3).unclear, 1.0);
}

TEST(Visibility, OfAPointBehindASurfaceIsHidden) {
  const Visibility v = of_point(all_around(2.0), {3.0, 0.0}, kPi / 2);
  EXPECT_EQ(v.hidden, 1.0);
  EXPECT_EQ(v.total(), 1.0);
}

TEST(Visibility, JustInFrontOrBehindIsUnclearUnlessThereIsSlack) {
  for (const double range_m : {1.85, 2.15}) {
    EXPECT_EQ(of_point(all_around(2.0), {range_m, 0.0}, kPi / 2).unclear, 1.0) << range_m;
    EXPECT_EQ(of_point(all_around(2.0), {range_m, 0.0}, kPi / 2, 2.0).agree, 1.0) << range_m;
  }
}

TEST(Visibility, WithoutAReturnIsUnclearAndBeyondTheFieldOfViewOutside) {
  EXPECT_EQ(of_point(all_around(0.0), {1.0, 0.0}, 0.0).unclear, 1.0);
  const ScanView ahead = seer({2.0, 2.0, 2.0}, -kPi / 4);
  EXPECT_EQ(of_point(ahead, {-1.0, 0.0}, 0.0).outside, 1.0);
  EXPECT_EQ(of_point(ScanView{}, {1.0, 0.0}, 0.0).outside, 1.0);
}

TEST(Visibility, TakesTheStrongestEvidenceOfSeveralSensors) {
  ScanView both = seer({2.0, 2.0, 2.0}, -kPi / 4);
  both.images.push_back(seer({3.0, 3.0, 3.0}, -kPi / 4).images[0]);
  EXPECT_EQ(of_point(both, {3.0, 0.0}, kPi / 2).agree, 1.0) << "hidden to the first";
  EXPECT_EQ(of_point(both, {2.5, 0.0}, kPi / 2).crossed, 1.0);
}

TEST(Visibility, AddsUpTheWeightsOfBothWays) {
  ScanView reference = all_around(2.0);
  add_point(reference, {1.0, 0.0}, kPi / 2, 0.5, 0.25);  // lies in front of what the query saw
  ScanView query = all_around(2.0);
  add_point(query, {2.0, 0.0}, kPi / 2, 2.0, 0.75);
  add_point(query, {0.0, 2.0}, kPi, 4.0, 0.125);
  add_point(query, {4.0, 0.0}, kPi / 2, 8.0, 1.0);
  const Visibility v = visibility(reference, query, {}, {0.10, 25 * kDegree, 0.20});
  EXPECT_EQ(v.agree, 6.0);
  EXPECT_EQ(v.crossed, 0.5);
  EXPECT_EQ(v.hidden, 8.0);
  EXPECT_EQ(v.total(), 14.5);
  EXPECT_EQ(v.cross_agree, 0.875);
  EXPECT_EQ(v.cross_total, 2.125);
}

TEST(Visibility, LooksAtPointsWhereThePosePutsThem) {
  ScanView query;
  add_point(query, {1.0, 0.0}, 0.0);
  // Turned by 90 degrees and shifted, the point is at (2, 0), its tangent upwards.
  EXPECT_EQ(visibility(all_around(2.0), query, {2.0, -1.0, kPi / 2}, {}).agree, 1.0);
}

TEST(Visibility, LooksAtEverySecondPointWhenAskedTo) {
  ScanView query;
  for (int k = 0; k < 10; ++k) add_point(query, {1.0, 0.0}, 0.0);
  EXPECT_EQ(visibility(all_around(2.0), query, {}, {}, {1.0, 2}).total(), 5.0);
  EXPECT_EQ(visibility(all_around(2.0), query, {}, {}, {1.0, 1}).total(), 10.0);
}

Visibility between(const test::World& world, const Pose2& a, const Pose2& b, const Pose2& candidate) {
  const ScanView reference = test::view_from(world, a, test::half_circle(), 1);
  const ScanView query = test::view_from(world, b, test::half_circle(), 2);
  return visibility(reference, query, candidate, {});
}

TEST(Visibility, IsTheSameFromEitherScan) {
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (unsigned seed = 0; seed < 40; ++seed) {
    const test::World world = test::cluttered_room(seed);
    const ScanView a = test::view_from(world, {unit(rng), unit(rng), 3 * unit(rng)}, test::half_circle(), 1);
    const ScanView b = test::view_from(world, {unit(rng), unit(rng), 3 * unit(rng)}, test::full_circle(), 2);
    const Pose2 a_from_b{unit(rng), unit(rng), 3 * unit(rng)};
    const Visibility there = visibility(a, b, a_from_b, {});
    const Visibility back = visibility(b, a, inverse(a_from_b), {});
    EXPECT_NEAR(there.agree, back.agree, 1e-9);
    EXPECT_NEAR(there.crossed, back.crossed, 1e-9);
    EXPECT_NEAR(there.hidden, back.hidden, 1e-9);
    EXPECT_NEAR(there.unclear, back.unclear, 1e-9);
    EXPECT_NEAR(there.outside, back.outside, 1e-9);
    EXPECT_NEAR(there.cross_agree, back.cross_agree, 1e-9);
    EXPECT_NEAR(visibility_score(there), visibility_score(back), 1e-9);
  }
}

TEST(Visibility, IsBestAtTheTruth) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const test::World world = test::cluttered_room(seed);
    const Pose2 b{0.4, -0.3, 0.2};
    const double truth = visibility_score(between(world, {}, b, b));
    for (const Pose2& off :
         {Pose2{0.5, 0.0, 0.0}, Pose2{0.0, -0.5, 0.0}, Pose2{0.0, 0.0, 0.3}, Pose2{-1.0, 1.0, 2.0}}) {
      EXPECT_GT(truth, visibility_score(between(world, {}, b, b * off)) + 1.0) << seed;
    }
  }
}

/// The distance along a bare corridor is unknown, and a preference for standing still would be false.
TEST(Visibility, OfABareCorridorDoesNotRewardMovingLess) {
  test::Scanner scanner = test::half_circle();
  scanner.max_range_m = 8.0;
  const test::World world = test::bare_corridor();
  const Visibility still = [&] {
    const ScanView a = test::view_from(world, {}, scanner, 1);
    return visibility(a, test::view_from(world, {}, scanner, 2), {}, {});
  }();
  const ScanView a = test::view_from(world, {}, scanner, 1);
  const ScanView b = test::view_from(world, {}, scanner, 2);
  for (const double shift_m : {0.1, 0.3, 0.6, 1.0}) {
    const Visibility moved = visibility(a, b, {shift_m, 0.0, 0.0}, {});
    EXPECT_LT(moved.crossed, 0.01 * moved.total()) << shift_m;
    EXPECT_NEAR(moved.agree / (moved.agree + moved.unclear + moved.crossed),
                still.agree / (still.agree + still.unclear + still.crossed), 0.10)
        << shift_m;
    EXPECT_NEAR(visibility_score(moved), visibility_score(still), 2.0) << shift_m;
  }
}

TEST(VisibilityScore, GrowsWithAgreementAndFallsWithCrossing) {
  Visibility v;
  v.agree = 5.0;
  v.hidden = 3.0;
  v.outside = 2.0;
  v.cross_agree = 1.0;
  v.cross_total = 2.0;
  const double before = visibility_score(v);
  Visibility agreed = v;
  agreed.hidden -= 1.0;
  agreed.agree += 1.0;
  EXPECT_GT(visibility_score(agreed), before);
  Visibility crossed = v;
  crossed.hidden -= 1.0;
  crossed.crossed += 1.0;
  EXPECT_LT(visibility_score(crossed), before);
}

TEST(VisibilityScore, LooksAtSharesAndIsFiniteForNothing) {
  Visibility v;
  v.agree = 5.0;
  v.crossed = 1.0;
  v.unclear = 2.0;
  v.cross_agree = 1.0;
  v.cross_total = 3.0;
  Visibility twice = v;
  twice += v;
  EXPECT_NEAR(visibility_score(twice), visibility_score(v), 1e-6);
  EXPECT_TRUE(std::isfinite(visibility_score({})));
}

}  // namespace
}  // namespace shapemap
