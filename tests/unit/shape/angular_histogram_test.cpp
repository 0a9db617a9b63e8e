// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/shape/angular_histogram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shapemap/shape/point_index.hpp"

namespace shapemap {
namespace {

using Counts = std::array<int, kHistogramBins>;

Shape shape_of_points(const std::vector<Point2>& points) {
  Shape shape;
  for (const Point2& p : points) shape.points.push_back({p, 0.0, 0});
  return shape;
}

Shape random_shape(unsigned seed, int count, double size_m) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> place(0.0, size_m);
  std::vector<Point2> points;
  for (int i = 0; i < count; ++i) {
    const double x_m = place(rng);
    points.emplace_back(x_m, place(rng));
  }
  return shape_of_points(points);
}

Counts counts_with(const std::vector<std::pair<std::size_t, int>>& filled) {
  Counts counts{};
  for (const auto& [bin, count] : filled) counts.at(bin) = count;
  return counts;
}

std::vector<AngularHistogram> histograms_of(const Shape& shape, double radius_m, double rotation_rad = 0.0,
                                            HistogramNorm norm = HistogramNorm::kMaximum) {
  return NeighbourDirections(shape, radius_m).histograms(rotation_rad, norm);
}

TEST(NormalisedHistogram, ByMaximumHasOneFullBin) {
  const AngularHistogram h = normalised(counts_with({{0, 4}, {7, 1}, {35, 2}}), HistogramNorm::kMaximum);
  EXPECT_EQ(h.bins[0], 252);
  EXPECT_EQ(h.bins[7], 63);
  EXPECT_EQ(h.bins[35], 126);
  EXPECT_EQ(h.bins[1], 0);
}

TEST(NormalisedHistogram, ByL2HasLengthOne) {
  const AngularHistogram h = normalised(counts_with({{3, 3}, {4, 4}}), HistogramNorm::kL2);
  EXPECT_EQ(h.bins[3], 151);  // 0.6 of 252 is 151.2
  EXPECT_EQ(h.bins[4], 202);  // 0.8 of 252 is 201.6
}

TEST(NormalisedHistogram, ByCountSumsToOne) {
  const AngularHistogram h = normalised(counts_with({{1, 1}, {2, 2}, {30, 4}}), HistogramNorm::kCount);
  EXPECT_EQ(h.bins[1], 36);
  EXPECT_EQ(h.bins[2], 72);
  EXPECT_EQ(h.bins[30], 144);
}

TEST(NormalisedHistogram, OfNothingIsNothingUnderAnyNorm) {
  for (const HistogramNorm norm : {HistogramNorm::kMaximum, HistogramNorm::kL2, HistogramNorm::kCount}) {
    EXPECT_EQ(normalised(Counts{}, norm).bins, AngularHistogram{}.bins);
  }
}

TEST(AngularHistogram, OfFourPointsAsWorkedOutByHand) {
  // The first point sees 5 degrees, 5 degrees (farther) and 95 degrees.
  const Point2 a(1.0, 1.0);
  const Shape shape = shape_of_points({a, a + rotate({0.2, 0.0}, 5 * kDegree), a + rotate({0.4, 0.0}, 5 * kDegree),
                                       a + rotate({0.3, 0.0}, 95 * kDegree)});
  const auto by_maximum = histograms_of(shape, 0.45);
  ASSERT_EQ(by_maximum.size(), 4U);
  EXPECT_EQ(by_maximum[0].bins, normalised(counts_with({{0, 2}, {9, 1}}), HistogramNorm::kMaximum).bins);
  // The last point sees the first at 275 deg, and the others at 275 + 33.7 and 275 + 53.1 (0.5 m, too far).
  EXPECT_EQ(by_maximum[3].bins, normalised(counts_with({{27, 1}, {30, 1}}), HistogramNorm::kMaximum).bins);
  const auto by_count = histograms_of(shape, 0.45, 0.0, HistogramNorm::kCount);
  EXPECT_EQ(by_count[0].bins[0], 168);
  EXPECT_EQ(by_count[0].bins[9], 84);
}

TEST(AngularHistogram, BinsStartAtTheirLowerEdge) {
  const Shape shape = shape_of_points({{0, 0}, {0.1, 0.0}, {0.0, 0.2}, {-0.3, 0.0}, {0.0, -0.4}});
  const AngularHistogram h = histograms_of(shape, 0.45)[0];
  EXPECT_EQ(h.bins, normalised(counts_with({{0, 1}, {9, 1}, {18, 1}, {27, 1}}), HistogramNorm::kMaximum).bins);
}

TEST(AngularHistogram, APointAtTheRadiusIsInsideAndOneBeyondIsNot) {
  const Shape shape = shape_of_points({{0.0, 0.0}, {0.5, 0.0}, {0.0, 0.5000001}});
  const AngularHistogram h = histograms_of(shape, 0.5)[0];
  EXPECT_EQ(h.bins, normalised(counts_with({{0, 1}}), HistogramNorm::kMaximum).bins);
}

TEST(AngularHistogram, APointInTheSamePlaceHasNoDirection) {
  const Shape shape = shape_of_points({{1.0, 1.0}, {1.0, 1.0}});
  for (const AngularHistogram& h : histograms_of(shape, 0.5)) EXPECT_EQ(h.bins, AngularHistogram{}.bins);
}

TEST(AngularHistogram, OfALonelyPointIsEmpty) {
  EXPECT_EQ(histograms_of(shape_of_points({{1.0, 1.0}}), 0.5).at(0).bins, AngularHistogram{}.bins);
  EXPECT_TRUE(histograms_of(Shape{}, 0.5).empty());
}

TEST(AngularHistogram, TurningByTenDegreesMovesEachBinByOne) {
  const NeighbourDirections directions(random_shape(1, 120, 2.0), 0.5);
  const auto straight = directions.histograms(0.0, HistogramNorm::kMaximum);
  for (int tens = -36; tens <= 36; ++tens) {
    const auto turned = directions.histograms(tens * 10 * kDegree, HistogramNorm::kMaximum);
    ASSERT_EQ(turned.size(), straight.size());
    for (std::size_t i = 0; i < straight.size(); ++i) {
      for (std::size_t b = 0; b < kHistogramBins; ++b) {
        const std::size_t to = (b + static_cast<std::size_t>(tens + 36)) % kHistogramBins;
        ASSERT_EQ(turned[i].bins[to], straight[i].bins[b]) << tens << " tens, point " << i << ", bin " << b;
      }
    }
  }
}

TEST(AngularHistogram, MovingTheShapeChangesNothing) {
  const Shape shape = random_shape(2, 100, 1.5);
  const Shape elsewhere = moved(shape, {0.5, -0.25, 0.0});
  const auto before = histograms_of(shape, 0.5);
  const auto after = histograms_of(elsewhere, 0.5);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i].bins, before[i].bins) << i;
}

TEST(AngularHistogram, TurningTheDirectionsIsTurningTheShape) {
  const Shape shape = random_shape(3, 100, 1.5);
  for (const double rotation_rad : {0.3, -1.1, 3.0, 7.0}) {
    const auto turned = histograms_of(shape, 0.5, rotation_rad);
    const auto rebuilt = histograms_of(moved(shape, {0.0, 0.0, rotation_rad}), 0.5);
    for (std::size_t i = 0; i < turned.size(); ++i) ASSERT_EQ(turned[i].bins, rebuilt[i].bins) << i;
  }
}

TEST(AngularHistogram, EqualsBruteForceOnRandomShapes) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    const double radius_m = 0.2 + 0.02 * seed;
    const Shape shape = random_shape(seed, 10 + 5 * static_cast<int>(seed), 1.0 + 0.1 * seed);
    const auto found = histograms_of(shape, radius_m, 0.0, HistogramNorm::kL2);
    for (std::size_t i = 0; i < shape.size(); ++i) {
      Counts counts{};
      for (std::size_t j = 0; j < shape.size(); ++j) {
        const Point2 to = shape.points[j].p_m - shape.points[i].p_m;
        if (j == i || std::hypot(to.x(), to.y()) > radius_m) continue;
        double degrees = std::atan2(to.y(), to.x()) / kDegree;
        if (degrees < 0.0) degrees += 360.0;
        ++counts.at(static_cast<std::size_t>(degrees / 10.0) % kHistogramBins);
      }
      ASSERT_EQ(found[i].bins, normalised(counts, HistogramNorm::kL2).bins) << seed << ", point " << i;
    }
  }
}

TEST(PointIndex, FindsWhatBruteForceFinds) {
  std::mt19937 rng(4);
  std::uniform_int_distribution<int> cell(0, 12);  // on a lattice, many distances are exactly the radius
  std::vector<Point2> points;
  for (int i = 0; i < 300; ++i) {
    const int column = cell(rng);
    points.emplace_back(0.25 * column, 0.25 * cell(rng));
  }
  const PointIndex index(points);
  for (const Point2& p : points) {
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((points[i] - p).squaredNorm() <= 0.5 * 0.5) expected.push_back(i);
    }
    ASSERT_EQ(index.within(p, 0.5), expected);
    ASSERT_EQ(index.nearest(p).distance_m, 0.0);
    double nearest_m = 1e9;
    const Point2 off = p + Point2(0.07, 0.11);
    for (const Point2& q : points) nearest_m = std::min(nearest_m, (q - off).norm());
    ASSERT_NEAR(index.nearest(off).distance_m, nearest_m, 1e-12);
  }
}

TEST(PointIndex, OfNothingFindsNothing) {
  const PointIndex index({});
  EXPECT_EQ(index.size(), 0U);
  EXPECT_TRUE(std::isinf(index.nearest({0.0, 0.0}).distance_m));
  EXPECT_TRUE(index.within({0.0, 0.0}, 10.0).empty());
}

}  // namespace
}  // namespace shapemap
