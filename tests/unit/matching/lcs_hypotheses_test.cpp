// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/lcs_hypotheses.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "support/views.hpp"

namespace shapemap {
namespace {

TEST(LcsHypotheses, HaveTheTranslationAmongThem) {
  int num_found = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const test::World world = test::cluttered_room(seed, 4);
    const Pose2 truth{0.3, -0.2, 0.5};
    const ScanView reference = test::view_from(world, {}, test::full_circle(), 1);
    const ScanView query = test::view_from(world, truth, test::full_circle(), 2);
    const std::vector<Point2> shifts_m = LcsHypotheses(reference, query).translations(truth.theta_rad, 5);
    num_found += std::any_of(shifts_m.begin(), shifts_m.end(),
                             [&](const Point2& shift_m) { return (shift_m - truth.translation()).norm() < 0.3; });
  }
  EXPECT_GE(num_found, 15);
}

TEST(LcsHypotheses, OfACopyBeginWithNoTranslation) {
  const ScanView view = test::view_from(test::cluttered_room(1), {});
  const std::vector<Point2> shifts_m = LcsHypotheses(view, view).translations(0.0, 3);
  ASSERT_FALSE(shifts_m.empty());
  EXPECT_LT(shifts_m[0].norm(), 1e-9);
}

TEST(LcsHypotheses, AreNoMoreThanAskedForAndTheFirstOfAll) {
  const ScanView reference = test::view_from(test::cluttered_room(1), {});
  const ScanView query = test::view_from(test::cluttered_room(1), {0.3, 0.1, 0.2});
  const LcsHypotheses shapes(reference, query);
  const std::vector<Point2> all = shapes.translations(0.2, 1000);
  ASSERT_GT(all.size(), 3U);
  for (const int count : {0, 1, 3}) {
    const std::vector<Point2> some = shapes.translations(0.2, count);
    EXPECT_EQ(some, std::vector<Point2>(all.begin(), all.begin() + count));
  }
}

TEST(LcsHypotheses, OfNothingAreNone) {
  const ScanView nothing;
  const ScanView room = test::view_from(test::cluttered_room(1), {});
  EXPECT_TRUE(LcsHypotheses(nothing, room).translations(0.0, 5).empty());
  EXPECT_TRUE(LcsHypotheses(room, nothing).translations(0.0, 5).empty());
  EXPECT_TRUE(LcsHypotheses(nothing, nothing).translations(0.0, 5).empty());
}

}  // namespace
}  // namespace shapemap
