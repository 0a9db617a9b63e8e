// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/scan_overlap.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <random>

namespace shapemap {
namespace {

OverlapOptions with_rule(OverlapRule rule) { return {0.40, 10 * kDegree, rule}; }

PartialMap map_of(const std::vector<ShapePoint>& points) { return {{Shape{points, 1}}, false, 0.5}; }

Shape query_of(const std::vector<ShapePoint>& points) { return {points, 1}; }

TEST(PartnersWithin, RulesDifferWhereTheNearestPointHasAnotherTangent) {
  const PartialMap target = map_of({{{0.1, 0.0}, 90 * kDegree, 0}, {{0.3, 0.0}, 0.0, 0}});
  const Shape query = query_of({{{0.0, 0.0}, 0.0, 0}});
  EXPECT_TRUE(partners_within(target, query, {}, {0.4}, with_rule(OverlapRule::kNearest)).empty());
  const std::vector<Partner> any = partners_within(target, query, {}, {0.4}, with_rule(OverlapRule::kAny));
  ASSERT_EQ(any.size(), 1U);
  EXPECT_EQ(any[0].target, 1U);
  EXPECT_DOUBLE_EQ(any[0].distance_m, 0.3);
}

TEST(PartnersWithin, RulesAgreeWhereTheNearestPointIsSimilar) {
  const PartialMap target = map_of({{{0.3, 0.0}, 0.0, 0}, {{0.1, 0.0}, 5 * kDegree, 0}});
  const Shape query = query_of({{{5.0, 5.0}, 0.0, 0}, {{0.0, 0.0}, 0.0, 0}});
  for (const OverlapRule rule : {OverlapRule::kNearest, OverlapRule::kAny}) {
    const std::vector<Partner> partners = partners_within(target, query, {}, {0.4}, with_rule(rule));
    ASSERT_EQ(partners.size(), 1U);
    EXPECT_EQ(partners[0].query, 1U);
    EXPECT_EQ(partners[0].target, 1U);
    EXPECT_DOUBLE_EQ(partners[0].distance_m, 0.1);
  }
}

TEST(PartnersWithin, ThePoseMovesPointsAndTurnsTangents) {
  const PartialMap target = map_of({{{2.0, 1.0}, 90 * kDegree, 0}});
  const Shape query = query_of({{{1.0, 0.0}, 0.0, 0}});
  for (const OverlapRule rule : {OverlapRule::kNearest, OverlapRule::kAny}) {
    EXPECT_EQ(partners_within(target, query, {2.0, 0.0, 90 * kDegree}, {1e-9}, with_rule(rule)).size(), 1U);
    EXPECT_TRUE(partners_within(target, query, {1.0, 1.0, 0.0}, {1e-9}, with_rule(rule)).empty());
  }
}

TEST(PartnersWithin, APartnerExactlyAtTheDistanceCountsUnderBothRules) {
  const PartialMap target = map_of({{{0.5, 0.0}, 0.0, 0}});
  const Shape query = query_of({{{0.0, 0.0}, 0.0, 0}});
  for (const OverlapRule rule : {OverlapRule::kNearest, OverlapRule::kAny}) {
    EXPECT_EQ(partners_within(target, query, {}, {0.5}, with_rule(rule)).size(), 1U);
    EXPECT_TRUE(partners_within(target, query, {}, {0.4999}, with_rule(rule)).empty());
  }
}

TEST(PartnersWithin, EqualBruteForceUnderBothRules) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> place(0.0, 2.0);
  std::uniform_real_distribution<double> turn(-0.5, 0.5);
  const auto random_points = [&](int count) {
    std::vector<ShapePoint> points;
    for (int i = 0; i < count; ++i) {
      const double x_m = place(rng);
      const double y_m = place(rng);
      points.push_back({{x_m, y_m}, kPi + turn(rng), 0});  // about the seam
    }
    return points;
  };
  const std::vector<ShapePoint> target_points = random_points(80);
  const PartialMap target = map_of(target_points);
  const Shape query = query_of(random_points(150));
  const Pose2 pose{0.1, -0.2, 0.1};
  for (const OverlapRule rule : {OverlapRule::kNearest, OverlapRule::kAny}) {
    const std::vector<Partner> found = partners_within(target, query, pose, {0.2}, with_rule(rule));
    std::size_t k = 0;
    for (std::size_t q = 0; q < query.size(); ++q) {
      std::optional<Partner> best;
      for (std::size_t t = 0; t < target_points.size(); ++t) {
        const bool similar =
            angle_between(target_points[t].tangent_rad, query.points[q].tangent_rad + 0.1) <= 10 * kDegree;
        const double distance_m = (target_points[t].p_m - pose * query.points[q].p_m).norm();
        if (rule == OverlapRule::kAny && !similar) continue;
        if (!best || distance_m < best->distance_m) best = Partner{q, similar ? t : target_points.size(), distance_m};
      }
      if (!best || best->distance_m > 0.2 || best->target == target_points.size()) continue;
      ASSERT_LT(k, found.size());
      EXPECT_EQ(found[k].query, q);
      EXPECT_EQ(found[k].target, best->target);
      EXPECT_NEAR(found[k].distance_m, best->distance_m, 1e-12);
      ++k;
    }
    EXPECT_EQ(k, found.size());
    EXPECT_GT(k, 20U);
  }
}

TEST(PartnersWithin, GivesUpWhenAsManyAsAskedForCannotBeReached) {
  const PartialMap target = map_of({{{0.0, 0.0}, 0.0, 0}});
  std::vector<ShapePoint> points(10, {{0.0, 0.1}, 0.0, 0});
  for (std::size_t i = 0; i < 5; ++i) points[i].p_m.x() = 9.0;  // far from everything
  const Shape query = query_of(points);
  for (const OverlapRule rule : {OverlapRule::kNearest, OverlapRule::kAny}) {
    EXPECT_EQ(partners_within(target, query, {}, {0.5, 5}, with_rule(rule)).size(), 5U);
    EXPECT_LT(partners_within(target, query, {}, {0.5, 6}, with_rule(rule)).size(), 5U);
  }
}

TEST(ScanOverlap, CountsPartnersAndAveragesTheirDistances) {
  const ScanOverlap overlap = scan_overlap({{0, 0, 0.1}, {1, 5, 0.2}, {2, 5, 0.6}});
  EXPECT_EQ(overlap.num_points, 3);
  EXPECT_NEAR(overlap.mean_distance_m, 0.3, 1e-15);
}

TEST(ScanOverlap, OfNoPartnersIsZero) {
  EXPECT_EQ(scan_overlap({}).num_points, 0);
  EXPECT_EQ(scan_overlap({}).mean_distance_m, 0.0);
}

TEST(PartialMap, KeepsScansApartOrInARow) {
  const Shape first{{{{0.0, 0.0}, 0.1, 0}, {{1.0, 0.0}, 0.2, 0}}, 1};
  const Shape second{{{{2.0, 0.0}, 0.3, 0}}, 1};
  const PartialMap apart({first, second}, false, 0.5);
  ASSERT_EQ(apart.sequences().size(), 2U);
  const PartialMap row({first, second}, true, 0.5);
  ASSERT_EQ(row.sequences().size(), 1U);
  EXPECT_EQ(row.sequences()[0].shape.size(), 3U);
  for (const PartialMap* map : {&apart, &row}) {
    ASSERT_EQ(map->num_points(), 3U);
    EXPECT_EQ(map->point(2).tangent_rad, 0.3);
    EXPECT_EQ(map->index().nearest({1.9, 0.0}).point, 2U);
  }
}

}  // namespace
}  // namespace shapemap
