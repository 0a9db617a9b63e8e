// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/loops/place_descriptor.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/random_graph.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

ScanView view_of_points(const std::vector<ShapePoint>& points) {
  ScanView view;
  view.points = points;
  return view;
}

ShapePoint point(double x_m, double y_m, double tangent_deg) {
  ShapePoint result;
  result.p_m = {x_m, y_m};
  result.tangent_rad = tangent_deg * kDegree;
  return result;
}

/// The same surfaces, seen in another frame.
ScanView moved(const ScanView& view, const Pose2& other_from_robot) {
  std::vector<ShapePoint> points = view.points;
  for (ShapePoint& p : points) {
    p.p_m = other_from_robot * p.p_m;
    p.tangent_rad = wrap_angle(p.tangent_rad + other_from_robot.theta_rad);
  }
  return view_of_points(points);
}

PlaceSignature random_signature(std::mt19937& rng) {
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  PlaceSignature signature;
  float squares = 0.0F;
  for (float& value : signature) {
    value = unit(rng);
    squares += value * value;
  }
  for (float& value : signature) value /= std::sqrt(squares);
  return signature;
}

TEST(PlaceSignature, OfTwoPointsHasTwoEqualEntriesThatAnyTurnOrShiftKeeps) {
  const ScanView view = view_of_points({point(0.0, 0.0, 3.0), point(1.0, 0.0, 88.0)});
  const PlaceSignature signature = place_signature(view);
  EXPECT_EQ(std::count(signature.begin(), signature.end(), std::sqrt(0.5F)), 2);
  EXPECT_EQ(std::count(signature.begin(), signature.end(), 0.0F), static_cast<long>(kSignatureBins - 2));
  std::mt19937 rng(1);
  for (int round = 0; round < 100; ++round) {
    EXPECT_EQ(place_signature(moved(view, test::random_pose(rng, 50.0, kPi))), signature);
  }
}

TEST(PlaceSignature, TellsDistancesTurnsAndSidesApart) {
  const auto of_pair = [](const ShapePoint& other) {
    return place_signature(view_of_points({point(0.0, 0.0, 0.0), other}));
  };
  const PlaceSignature signature = of_pair(point(2.0, 0.0, 90.0));
  EXPECT_NEAR(likeness(signature, of_pair(point(2.05, 0.05, 95.0))), 1.0, 1e-6) << "small errors do no harm";
  EXPECT_EQ(likeness(signature, of_pair(point(4.0, 0.0, 90.0))), 0.0) << "farther";
  EXPECT_EQ(likeness(signature, of_pair(point(2.0, 0.0, -90.0))), 0.0) << "turned the other way: a mirror image";
  EXPECT_EQ(likeness(signature, of_pair(point(0.0, 2.0, 90.0))), 0.0) << "on another side";
}

TEST(PlaceSignature, OfRealScansIsTheSameInAnyFrame) {
  std::mt19937 rng(2);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const ScanView view = test::view_from(test::strange_place(seed), {});
    const PlaceSignature signature = place_signature(view);
    for (int round = 0; round < 5; ++round) {
      // Some pairs of points lie on a border between two bins to the last digit.
      EXPECT_GT(likeness(place_signature(moved(view, test::random_pose(rng, 20.0, kPi))), signature), 0.995) << seed;
    }
  }
}

TEST(PlaceSignature, APlaceLooksMoreLikeItselfThanLikeAnyOther) {
  constexpr unsigned kPlaces = 20;
  std::vector<PlaceSignature> known;
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    known.push_back(place_signature(test::view_from(test::strange_place(seed), {})));
  }
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    const Pose2 nearby{0.15, -0.1, 2.0 + seed};
    const PlaceSignature again =
        place_signature(test::view_from(test::strange_place(seed), nearby, test::full_circle(), 100 + seed));
    std::vector<double> alike;
    for (const PlaceSignature& other : known) alike.push_back(likeness(again, other));
    const auto best = std::max_element(alike.begin(), alike.end());
    EXPECT_EQ(best - alike.begin(), static_cast<long>(seed) - 1);
    EXPECT_GT(*best, 0.9);
    EXPECT_LT(*std::min_element(alike.begin(), alike.end()), 0.85);
  }
}

TEST(PlaceSignature, HasLengthOneAndLikenessIsBetweenNoneAndOne) {
  std::vector<PlaceSignature> signatures;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    signatures.push_back(place_signature(test::view_from(test::strange_place(seed), {})));
  }
  signatures.push_back(place_signature(test::view_from(test::bare_corridor(), {})));
  signatures.push_back(place_signature(test::view_from(test::round_room(), {})));
  for (const PlaceSignature& a : signatures) {
    EXPECT_NEAR(likeness(a, a), 1.0, 1e-5);
    for (const PlaceSignature& b : signatures) {
      EXPECT_GE(likeness(a, b), 0.0);
      EXPECT_LE(likeness(a, b), 1.0 + 1e-5);
      EXPECT_EQ(likeness(a, b), likeness(b, a));
    }
  }
}

TEST(PlaceSignature, OfNothingIsLikeNothing) {
  const PlaceSignature nothing = place_signature({});
  EXPECT_EQ(nothing, PlaceSignature{});
  EXPECT_EQ(place_signature(view_of_points({point(1.0, 2.0, 3.0)})), PlaceSignature{}) << "no pair";
  EXPECT_EQ(place_signature(view_of_points({point(0.0, 0.0, 0.0), point(100.0, 0.0, 0.0)})), PlaceSignature{});
  EXPECT_EQ(likeness(nothing, place_signature(test::view_from(test::uneven_room(), {}))), 0.0);
}

/// All of them, sorted; of equally alike ones the earlier first.
std::vector<LikelyPlace> by_full_sort(const std::vector<PlaceSignature>& signatures, std::size_t node, std::size_t end,
                                      std::size_t count) {
  std::vector<LikelyPlace> places;
  for (std::size_t other = 0; other < end; ++other) {
    places.push_back({other, likeness(signatures[node], signatures[other])});
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const LikelyPlace& a, const LikelyPlace& b) { return a.likeness > b.likeness; });
  std::vector<LikelyPlace> kept;
  std::vector<bool> taken(end + 2, false);  // shifted by one
  for (const LikelyPlace& place : places) {
    const std::size_t at = place.node + 1;
    const bool beside = taken[at - 1] || taken[at] || (at + 1 < taken.size() && taken[at + 1]);
    if (beside || kept.size() == count) continue;
    taken[at] = true;
    kept.push_back(place);
  }
  return kept;
}

TEST(PlaceIndex, FindsTheFirstOfAFullSortAndOfNeighboursTheBetter) {
  std::mt19937 rng(3);
  constexpr std::size_t kCount = 60;
  std::vector<PlaceSignature> signatures;
  PlaceIndex index;
  for (std::size_t i = 0; i < kCount; ++i) {
    const bool seen_before = i > 10 && i % 4 == 0;  // ties
    signatures.push_back(seen_before ? signatures[i / 3] : random_signature(rng));
    index.add(signatures.back());
  }
  ASSERT_EQ(index.size(), kCount);
  for (std::size_t node = 0; node < kCount; ++node) {
    for (const std::size_t count : {0U, 1U, 7U, 1000U}) {
      const std::size_t end = node - std::min<std::size_t>(node, node % 5);
      const std::vector<LikelyPlace> found = index.most_alike(node, end, count);
      const std::vector<LikelyPlace> expected = by_full_sort(signatures, node, end, count);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].node, expected[k].node);
        EXPECT_EQ(found[k].likeness, expected[k].likeness);
      }
    }
  }
}

}  // namespace
}  // namespace shapemap
