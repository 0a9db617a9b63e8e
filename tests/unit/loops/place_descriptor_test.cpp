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

/// Returns the same surfaces in another frame.
ScanView moved(const ScanView& view, const Pose2& other_from_robot) {
  std::vector<ShapePoint> points = view.points;
  for (ShapePoint& p : points) {
    p.p_m = other_from_robot * p.p_m;
    p.tangent_rad = wrap_angle(p.tangent_rad + other_from_robot.theta_rad);
  }
  return view_of_points(points);
}

PlaceDescriptor random_signature(std::mt19937& rng) {
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  PlaceDescriptor descriptor;
  float squares = 0.0F;
  for (float& value : descriptor) {
    value = unit(rng);
    squares += value * value;
  }
  for (float& value : descriptor) value /= std::sqrt(squares);
  return descriptor;
}

TEST(PlaceDescriptor, OfTwoPointsHasTwoEqualEntriesThatAnyTurnOrShiftKeeps) {
  const ScanView view = view_of_points({point(0.0, 0.0, 3.0), point(1.0, 0.0, 88.0)});
  const PlaceDescriptor descriptor = place_descriptor(view);
  EXPECT_EQ(std::count(descriptor.begin(), descriptor.end(), std::sqrt(0.5F)), 2);
  EXPECT_EQ(std::count(descriptor.begin(), descriptor.end(), 0.0F), static_cast<long>(kDescriptorBins - 2));
  std::mt19937 rng(1);
  for (int round = 0; round < 100; ++round) {
    EXPECT_EQ(place_descriptor(moved(view, test::random_pose(rng, 50.0, kPi))), descriptor);
  }
}

TEST(PlaceDescriptor, TellsDistancesTurnsAndSidesApart) {
  const auto of_pair = [](const ShapePoint& other) {
    return place_descriptor(view_of_points({point(0.0, 0.0, 0.0), other}));
  };
  const PlaceDescriptor descriptor = of_pair(point(2.0, 0.0, 90.0));
  EXPECT_NEAR(similarity(descriptor, of_pair(point(2.05, 0.05, 95.0))), 1.0, 1e-6) << "small errors do no harm";
  EXPECT_EQ(similarity(descriptor, of_pair(point(4.0, 0.0, 90.0))), 0.0) << "farther";
  EXPECT_EQ(similarity(descriptor, of_pair(point(2.0, 0.0, -90.0))), 0.0) << "turned the other way: a mirror image";
  EXPECT_EQ(similarity(descriptor, of_pair(point(0.0, 2.0, 90.0))), 0.0) << "on another side";
}

TEST(PlaceDescriptor, OfRealScansIsTheSameInAnyFrame) {
  std::mt19937 rng(2);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const ScanView view = test::view_from(test::strange_place(seed), {});
    const PlaceDescriptor descriptor = place_descriptor(view);
    for (int round = 0; round < 5; ++round) {
      // The descriptors are not equal, since some pairs of points lie exactly on the border of two bins.
      EXPECT_GT(similarity(place_descriptor(moved(view, test::random_pose(rng, 20.0, kPi))), descriptor), 0.995)
          << seed;
    }
  }
}

TEST(PlaceDescriptor, APlaceLooksMoreLikeItselfThanLikeAnyOther) {
  constexpr unsigned kPlaces = 20;
  std::vector<PlaceDescriptor> known;
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    known.push_back(place_descriptor(test::view_from(test::strange_place(seed), {})));
  }
  for (unsigned seed = 1; seed <= kPlaces; ++seed) {
    const Pose2 nearby{0.15, -0.1, 2.0 + seed};
    const PlaceDescriptor again =
        place_descriptor(test::view_from(test::strange_place(seed), nearby, test::full_circle(), 100 + seed));
    std::vector<double> alike;
    for (const PlaceDescriptor& other : known) alike.push_back(similarity(again, other));
    const auto best = std::max_element(alike.begin(), alike.end());
    EXPECT_EQ(best - alike.begin(), static_cast<long>(seed) - 1);
    EXPECT_GT(*best, 0.9);
    EXPECT_LT(*std::min_element(alike.begin(), alike.end()), 0.85);
  }
}

TEST(PlaceDescriptor, HasLengthOneAndSimilarityIsBetweenZeroAndOne) {
  std::vector<PlaceDescriptor> descriptors;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    descriptors.push_back(place_descriptor(test::view_from(test::strange_place(seed), {})));
  }
  descriptors.push_back(place_descriptor(test::view_from(test::bare_corridor(), {})));
  descriptors.push_back(place_descriptor(test::view_from(test::round_room(), {})));
  for (const PlaceDescriptor& a : descriptors) {
    EXPECT_NEAR(similarity(a, a), 1.0, 1e-5);
    for (const PlaceDescriptor& b : descriptors) {
      EXPECT_GE(similarity(a, b), 0.0);
      EXPECT_LE(similarity(a, b), 1.0 + 1e-5);
      EXPECT_EQ(similarity(a, b), similarity(b, a));
    }
  }
}

TEST(PlaceDescriptor, OfAViewWithoutPointsIsSimilarToNothing) {
  const PlaceDescriptor nothing = place_descriptor({});
  EXPECT_EQ(nothing, PlaceDescriptor{});
  EXPECT_EQ(place_descriptor(view_of_points({point(1.0, 2.0, 3.0)})), PlaceDescriptor{}) << "no pair";
  EXPECT_EQ(place_descriptor(view_of_points({point(0.0, 0.0, 0.0), point(100.0, 0.0, 0.0)})), PlaceDescriptor{});
  EXPECT_EQ(similarity(nothing, place_descriptor(test::view_from(test::uneven_room(), {}))), 0.0);
}

/// Sorts all places, the earlier ones first among equally similar ones.
std::vector<LikelyPlace> by_full_sort(const std::vector<PlaceDescriptor>& descriptors, std::size_t node,
                                      std::size_t end, std::size_t count) {
  std::vector<LikelyPlace> places;
  for (std::size_t other = 0; other < end; ++other) {
    places.push_back({other, similarity(descriptors[node], descriptors[other])});
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const LikelyPlace& a, const LikelyPlace& b) { return a.similarity > b.similarity; });
  std::vector<LikelyPlace> kept;
  std::vector<bool> taken(end + 2, false);  // Its indices are shifted by one.
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
  std::vector<PlaceDescriptor> descriptors;
  PlaceIndex index;
  for (std::size_t i = 0; i < kCount; ++i) {
    const bool seen_before = i > 10 && i % 4 == 0;  // These make ties.
    descriptors.push_back(seen_before ? descriptors[i / 3] : random_signature(rng));
    index.add(descriptors.back());
  }
  ASSERT_EQ(index.size(), kCount);
  for (std::size_t node = 0; node < kCount; ++node) {
    for (const std::size_t count : {0U, 1U, 7U, 1000U}) {
      const std::size_t end = node - std::min<std::size_t>(node, node % 5);
      const std::vector<LikelyPlace> found = index.most_alike(node, end, count);
      const std::vector<LikelyPlace> expected = by_full_sort(descriptors, node, end, count);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].node, expected[k].node);
        EXPECT_EQ(found[k].similarity, expected[k].similarity);
      }
    }
  }
}

}  // namespace
}  // namespace shapemap
