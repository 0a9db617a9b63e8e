// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/filters.hpp"

#include <gmock/gmock.h>

#include <random>

#include "support/matchers.hpp"

namespace shapemap {
namespace {

/// As in the paper: only the best main segment goes on.
Segments paper_segment_filter(const Segments& segments, FilterOptions options) {
  options.main_segments = 1;
  const std::vector<Segments> best = segment_filter(segments, options);
  return best.empty() ? Segments{} : best.front();
}

using test::IsNearPoint;

constexpr FilterOptions kPaper{10 * kDegree, 0.30, 2.0, 0.20};

/// A correspondence by where its query point lies and how far its partner is from it.
Correspondence at(const Point2& query_m, const Point2& translation_m, std::size_t target_scan = 0) {
  Correspondence c;
  c.query_m = query_m;
  c.target_m = query_m + translation_m;
  c.target_scan = target_scan;
  return c;
}

Correspondences segment(double x_m, std::size_t count, const Point2& translation_m) {
  return Correspondences(count, at({x_m, 0.0}, translation_m));
}

bool survives(double translation_deg, double query_tangent_deg, double target_tangent_deg) {
  Correspondence c = at({1.0, 2.0}, rotate({0.3, 0.0}, translation_deg * kDegree));
  c.query_tangent_rad = query_tangent_deg * kDegree;
  c.target_tangent_rad = target_tangent_deg * kDegree;
  return collinear_filter({c}, kPaper).size() == 1;
}

std::vector<std::size_t> sizes_of(const Segments& segments) {
  std::vector<std::size_t> sizes;
  for (const Correspondences& segment : segments) sizes.push_back(segment.size());
  return sizes;
}

TEST(CorrespondencesOf, CarryThePointsBehindTheIndices) {
  const Shape query{{{{1.0, 2.0}, 0.1, 0}, {{3.0, 4.0}, 0.2, 0}}, 1};
  const Shape target{{{{5.0, 6.0}, 0.3, 0}, {{7.0, 9.0}, 0.4, 0}}, 1};
  const Correspondences found = correspondences_of({{1, 0}}, query, target, 2);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].query_m, Point2(3.0, 4.0));
  EXPECT_EQ(found[0].target_m, Point2(5.0, 6.0));
  EXPECT_EQ(found[0].translation_m(), Point2(2.0, 2.0));
  EXPECT_EQ(found[0].query_tangent_rad, 0.2);
  EXPECT_EQ(found[0].target_tangent_rad, 0.3);
  EXPECT_EQ(found[0].indices, (IndexPair{1, 0}));
  EXPECT_EQ(found[0].target_scan, 2U);
}

TEST(CollinearFilter, DropsWhatSlidesAlongTheWall) {
  EXPECT_FALSE(survives(90.0, 90.0, 90.0));
  EXPECT_TRUE(survives(0.0, 90.0, 90.0));
}

TEST(CollinearFilter, DropsUpToTenDegreesFromTheTangent) {
  EXPECT_FALSE(survives(99.9, 90.0, 90.0));
  EXPECT_FALSE(survives(80.1, 90.0, 90.0));
  EXPECT_TRUE(survives(100.1, 90.0, 90.0));
  EXPECT_TRUE(survives(79.9, 90.0, 90.0));
}

TEST(CollinearFilter, EitherTangentIsEnough) {
  EXPECT_FALSE(survives(30.0, 35.0, 45.0));
  EXPECT_FALSE(survives(30.0, 45.0, 35.0));
  EXPECT_TRUE(survives(30.0, 45.0, 41.0));
}

TEST(CollinearFilter, SlidingBackwardsIsSlidingToo) {
  EXPECT_FALSE(survives(-90.0, 90.0, 90.0));
  EXPECT_FALSE(survives(175.0, 0.0, 40.0));
  EXPECT_FALSE(survives(-175.0, 0.0, 40.0));
  EXPECT_FALSE(survives(3.0, 178.0, 120.0));
}

TEST(CollinearFilter, KeepsATranslationOfZero) {
  Correspondence c = at({1.0, 2.0}, {0.0, 0.0});
  c.query_tangent_rad = c.target_tangent_rad = 0.0;
  EXPECT_EQ(collinear_filter({c}, kPaper).size(), 1U);
}

TEST(CollinearFilter, KeepsTheOrderOfWhatStays) {
  Correspondences all;
  for (int i = 0; i < 6; ++i) {
    all.push_back(at({0.1 * i, 0.0}, i % 2 == 0 ? Point2(0.0, 0.2) : Point2(0.2, 0.0)));  // the wall runs along x
  }
  const Correspondences kept = collinear_filter(all, kPaper);
  ASSERT_EQ(kept.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(kept[k].query_m, all[2 * k].query_m);
}

TEST(CutIntoSegments, AJumpOfExactlyTheGapStartsANewOne) {
  FilterOptions options = kPaper;
  options.segment_gap_m = 0.25;  // which is exact
  const auto chain = [](double step_m) {
    return Correspondences{at({0.0, 0.0}, {1.0, 0.0}), at({step_m, 0.0}, {1.0, 0.0})};
  };
  EXPECT_EQ(sizes_of(cut_into_segments(chain(0.25), options)), (std::vector<std::size_t>{1, 1}));
  EXPECT_EQ(sizes_of(cut_into_segments(chain(0.2499), options)), (std::vector<std::size_t>{2}));
}

TEST(CutIntoSegments, AJumpOfThirtyCentimetresIsCutWithThePapersGap) {
  const Correspondences chain{at({0.0, 0.0}, {1.0, 0.0}), at({0.30, 0.0}, {0.7, 0.0}), at({0.59, 0.0}, {0.7, 0.0})};
  EXPECT_EQ(sizes_of(cut_into_segments(chain, kPaper)), (std::vector<std::size_t>{1, 2}));
}

TEST(CutIntoSegments, AJumpInTheTargetAloneIsAJump) {
  const Correspondences chain{at({0.0, 0.0}, {1.0, 0.0}), at({0.05, 0.0}, {1.0, 0.4}), at({0.1, 0.0}, {1.0, 0.4})};
  EXPECT_EQ(sizes_of(cut_into_segments(chain, kPaper)), (std::vector<std::size_t>{1, 2}));
}

TEST(CutIntoSegments, AnotherTargetScanStartsANewOne) {
  const Correspondences chain{at({0.0, 0.0}, {1.0, 0.0}, 0), at({0.05, 0.0}, {1.0, 0.0}, 1),
                              at({0.1, 0.0}, {1.0, 0.0}, 1)};
  EXPECT_EQ(sizes_of(cut_into_segments(chain, kPaper)), (std::vector<std::size_t>{1, 2}));
}

TEST(CutIntoSegments, OfNothingIsNothing) { EXPECT_TRUE(cut_into_segments({}, kPaper).empty()); }

TEST(SegmentFilter, DropsASegmentBeyondTwiceTheMainDistanceAndTwentyCentimetres) {
  // The main segment (5 pairs) translates by (1, 0) with a mean distance of 0.04 m: the limit is 0.28 m.
  Correspondences main;
  for (int i = 0; i < 2; ++i) main.push_back(at({0.0, 0.05 * i}, {1.05, 0.0}));
  for (int i = 2; i < 4; ++i) main.push_back(at({0.0, 0.05 * i}, {0.95, 0.0}));
  main.push_back(at({0.0, 0.2}, {1.0, 0.0}));
  const Correspondences near{at({3.0, 0.0}, {1.27, 0.0}), at({3.0, 0.1}, {1.27, 0.0})};
  const Correspondences far{at({6.0, 0.0}, {1.0, 0.29}), at({6.0, 0.1}, {1.0, 0.29})};
  const Segments kept = paper_segment_filter({near, main, far}, kPaper);
  ASSERT_EQ(sizes_of(kept), (std::vector<std::size_t>{2, 5}));
  EXPECT_EQ(kept[0][0].query_m, near[0].query_m);
  EXPECT_EQ(kept[1][0].query_m, main[0].query_m);
}

TEST(SegmentFilter, TheMainSegmentThatLeavesMostPairsWins) {
  // Three small ones that agree outvote a larger one.
  const Segments kept = paper_segment_filter(
      {segment(0, 2, {1, 0}), segment(1, 5, {0, 3}), segment(2, 2, {1, 0}), segment(3, 2, {1, 0})}, kPaper);
  EXPECT_EQ(sizes_of(kept), (std::vector<std::size_t>{2, 2, 2}));
}

TEST(SegmentFilter, NeverDropsTheMainSegment) {
  FilterOptions strict = kPaper;
  strict.segment_distance_factor = 0.5;
  strict.segment_distance_slack_m = 0.0;
  const Correspondences only{at({0.0, 0.0}, {1.0, 0.0}), at({0.1, 0.0}, {1.2, 0.0})};
  EXPECT_EQ(sizes_of(paper_segment_filter({only}, strict)), (std::vector<std::size_t>{2}));
}

TEST(SegmentFilter, GoesOnWithTheBestMainSegmentsThatMoveTheQueryElsewhere) {
  FilterOptions options = kPaper;
  const Segments segments{segment(0, 2, {1, 0}), segment(1, 5, {0, 3}), segment(2, 4, {1, 0.05})};
  options.main_segments = 5;
  const std::vector<Segments> both = segment_filter(segments, options);
  ASSERT_EQ(both.size(), 2U);  // the first and the last move the query to the same place
  EXPECT_EQ(sizes_of(both[0]), (std::vector<std::size_t>{2, 4}));
  EXPECT_EQ(sizes_of(both[1]), (std::vector<std::size_t>{5}));
  options.main_segments = 1;
  EXPECT_EQ(segment_filter(segments, options).size(), 1U);
}

TEST(SegmentFilter, OfNothingIsNothing) { EXPECT_TRUE(paper_segment_filter({}, kPaper).empty()); }

TEST(SegmentTranslation, KeepsThePairsWithinTheMeanDistanceOfItsSegment) {
  // Mean (1, 0); distances 0.1, 0.1, 0, 0.2, so 0.1 in the mean.
  const Correspondences first{at({0.0, 0.0}, {1.1, 0.0}), at({0.0, 0.1}, {1.1, 0.0}), at({0.0, 0.2}, {1.0, 0.0}),
                              at({0.0, 0.3}, {0.8, 0.0})};
  const Correspondences second{at({2.0, 0.0}, {1.0, 0.05}), at({2.0, 0.1}, {1.0, 0.5})};
  const SegmentTranslation best = segment_wise_translation({first, second});
  EXPECT_THAT(best.target_from_query_m, IsNearPoint(Point2(1.0, 0.0), 1e-12));
  EXPECT_NEAR(best.mean_distance_m, 0.1, 1e-12);
  ASSERT_EQ(best.num_correspondences, 4);
  EXPECT_EQ(best.kept[0].query_m, first[0].query_m);
  EXPECT_EQ(best.kept[2].query_m, first[2].query_m);
  EXPECT_EQ(best.kept[3].query_m, second[0].query_m);
}

TEST(SegmentTranslation, OfEqualSupportTheFirstWins) {
  const SegmentTranslation best = segment_wise_translation({{at({0, 0}, {1, 0})}, {at({3, 0}, {0, 2})}});
  EXPECT_EQ(best.target_from_query_m, Point2(1.0, 0.0));
  EXPECT_EQ(best.num_correspondences, 1);
}

TEST(SegmentTranslation, PairsExactlyAtTheMeanDistanceAreKeptWhateverTheRounding) {
  // Ten times 0.1 is less than 1 in floating point: the mean comes out below each of its parts.
  Correspondences segment;
  for (int i = 0; i < 10; ++i) segment.push_back(at({0.0, 0.0}, {i % 2 == 0 ? 0.1 : -0.1, 0.0}));
  EXPECT_EQ(segment_wise_translation({segment}).num_correspondences, 10);
}

TEST(SegmentTranslation, OfNothingHasNoSupport) {
  const SegmentTranslation none = segment_wise_translation({});
  EXPECT_EQ(none.num_correspondences, 0);
  EXPECT_TRUE(none.kept.empty());
}

}  // namespace
}  // namespace shapemap
