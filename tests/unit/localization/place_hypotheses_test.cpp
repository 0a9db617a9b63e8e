// SPDX-License-Identifier: GPL-3.0-or-later
#include "localization/place_hypotheses.hpp"

#include <gtest/gtest.h>

namespace shapemap {
namespace {

/// Returns a stretch of three keyframes at `place`.
PlacedStretch laid_at(const Pose2& place, double log_odds) {
  return {log_odds, {place, place * Pose2{1.0, 0.0, 0.0}, place * Pose2{2.0, 0.0, 0.0}}, {}};
}

constexpr Pose2 kHere{1.0, 2.0, 0.3};
constexpr Pose2 kElsewhere{6.0, 2.0, 0.3};

TEST(PlaceHypotheses, IsNotSureOfNothing) {
  EXPECT_FALSE(PlaceHypotheses().is_sure());
  PlaceHypotheses few;
  EXPECT_TRUE(few.add(laid_at(kHere, 7.5)));
  EXPECT_FALSE(few.is_sure());
}

TEST(PlaceHypotheses, IsSureOfTheOnlyPlace) {
  PlaceHypotheses places;
  EXPECT_TRUE(places.add(laid_at(kElsewhere, 4.0)));
  EXPECT_TRUE(places.add(laid_at(kHere, 8.0)));
  EXPECT_FALSE(places.add(laid_at(kElsewhere, -6.5)));
  EXPECT_TRUE(places.is_sure());
  EXPECT_EQ(places.best().map_from_keyframe.front(), kHere);
}

TEST(PlaceHypotheses, IsNotSureBetweenTwoThatLookAlike) {
  for (const bool better_first : {true, false}) {
    PlaceHypotheses places;
    places.add(laid_at(kHere, better_first ? 20.0 : 16.5));
    places.add(laid_at(kElsewhere, better_first ? 16.5 : 20.0));
    EXPECT_FALSE(places.is_sure());
  }
}

TEST(PlaceHypotheses, TakesThoseNearEachOtherForOne) {
  PlaceHypotheses places;
  places.add(laid_at(kHere, 20.0));
  places.add(laid_at(kHere * Pose2{0.2, -0.3, 0.05}, 19.5));
  EXPECT_TRUE(places.is_sure());
  places.add(laid_at(kHere * Pose2{0.0, 0.0, 0.6}, 19.5));  // the stretch ends elsewhere
  EXPECT_FALSE(places.is_sure());
}

TEST(PlaceHypotheses, KnowsWhatWasTried) {
  PlaceHypotheses places;
  EXPECT_FALSE(places.has(1, kHere));
  places.add(laid_at(kHere, 3.0));
  EXPECT_TRUE(places.has(0, kHere));
  EXPECT_TRUE(places.has(1, kHere * Pose2{1.1, 0.1, 0.02}));
  EXPECT_FALSE(places.has(1, kHere));
}

}  // namespace
}  // namespace shapemap
