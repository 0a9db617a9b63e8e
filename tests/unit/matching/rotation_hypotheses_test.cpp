// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/matching/rotation_hypotheses.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "support/matchers.hpp"
#include "support/views.hpp"

namespace shapemap {
namespace {

using test::IsNearAngle;

TangentHistogram random_histogram(unsigned seed, double filled = 1.0) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  TangentHistogram histogram{};
  for (double& bin : histogram) bin = unit(rng) < filled ? unit(rng) : 0.0;
  return histogram;
}

TangentHistogram rotated(const TangentHistogram& histogram, std::size_t bins) {
  TangentHistogram result{};
  for (std::size_t i = 0; i < kTangentBins; ++i) result[(i + bins) % kTangentBins] = histogram[i];
  return result;
}

double correlation(const TangentHistogram& reference, const TangentHistogram& query, std::size_t turn) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kTangentBins; ++i) sum += query[i] * reference[(i + turn) % kTangentBins];
  return sum;
}

/// Returns the bins of all local maxima, best first, by their definition.
std::vector<std::size_t> peaks(const TangentHistogram& reference, const TangentHistogram& query) {
  std::vector<double> heights;
  for (std::size_t turn = 0; turn < kTangentBins; ++turn) heights.push_back(correlation(reference, query, turn));
  std::vector<std::size_t> found;
  for (std::size_t turn = 0; turn < kTangentBins; ++turn) {
    const double beside =
        std::max(heights[(turn + 1) % kTangentBins], heights[(turn + kTangentBins - 1) % kTangentBins]);
    if (heights[turn] > beside) found.push_back(turn);
  }
  std::sort(found.begin(), found.end(), [&](std::size_t a, std::size_t b) { return heights[a] > heights[b]; });
  return found;
}

TEST(RotationHypotheses, AreThePeaksOfTheCorrelation) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const TangentHistogram reference = random_histogram(seed, seed % 2 ? 1.0 : 0.1);
    const TangentHistogram query = random_histogram(1000 + seed, seed % 3 ? 1.0 : 0.1);
    const std::vector<std::size_t> expected = peaks(reference, query);
    const std::vector<double> found = rotation_hypotheses(reference, query, 360);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_THAT(found[i], IsNearAngle(static_cast<double>(expected[i]) * kDegree, 0.5001 * kDegree)) << i;
    }
  }
}

TEST(RotationHypotheses, AreBestFirstAndNoMoreThanAskedFor) {
  const TangentHistogram reference = random_histogram(1);
  const TangentHistogram query = random_histogram(2);
  const std::vector<double> all = rotation_hypotheses(reference, query, 360);
  ASSERT_GT(all.size(), 8U);
  for (const int count : {1, 2, 8}) {
    const std::vector<double> some = rotation_hypotheses(reference, query, count);
    EXPECT_EQ(some, std::vector<double>(all.begin(), all.begin() + count));
  }
}

TEST(RotationHypotheses, OfATurnedCopyBeginWithItsTurn) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const TangentHistogram reference = random_histogram(seed);
    const std::size_t turn = (seed * 37) % kTangentBins;
    const std::vector<double> found = rotation_hypotheses(rotated(reference, turn), reference, 3);
    ASSERT_FALSE(found.empty());
    EXPECT_THAT(found[0], IsNearAngle(static_cast<double>(turn) * kDegree, 0.5 * kDegree));
  }
}

TEST(RotationHypotheses, TurnWithTheirScans) {
  const TangentHistogram reference = random_histogram(3);
  const TangentHistogram query = random_histogram(4);
  const std::vector<double> found = rotation_hypotheses(reference, query, 10);
  for (const std::size_t turn : {1U, 90U, 359U}) {
    const std::vector<double> query_turned = rotation_hypotheses(reference, rotated(query, turn), 10);
    const std::vector<double> reference_turned = rotation_hypotheses(rotated(reference, turn), query, 10);
    ASSERT_EQ(query_turned.size(), found.size());
    ASSERT_EQ(reference_turned.size(), found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double turn_rad = static_cast<double>(turn) * kDegree;
      EXPECT_THAT(query_turned[i], IsNearAngle(found[i] - turn_rad, 1e-6));
      EXPECT_THAT(reference_turned[i], IsNearAngle(found[i] + turn_rad, 1e-6));
    }
  }
}

TEST(RotationHypotheses, OfARoomSeenFromElsewhereHaveTheHeadingAmongThem) {
  const test::World world = test::cluttered_room(5);
  const ScanView reference = test::view_from(world, {});
  for (int k = 0; k < 36; ++k) {
    const double heading_rad = 10.0 * k * kDegree;
    const ScanView query = test::view_from(world, {0.4, -0.3, heading_rad}, test::full_circle(), 2);
    double nearest_rad = kPi;
    for (const double rotation_rad : rotation_hypotheses(reference.tangents, query.tangents, 8)) {
      nearest_rad = std::min(nearest_rad, angle_between(rotation_rad, heading_rad));
    }
    EXPECT_LT(nearest_rad, 3.0 * kDegree) << 10 * k;
  }
}

TEST(RotationHypotheses, OfNothingAreNone) {
  const TangentHistogram nothing{};
  EXPECT_TRUE(rotation_hypotheses(nothing, random_histogram(1), 8).empty());
  EXPECT_TRUE(rotation_hypotheses(random_histogram(1), nothing, 8).empty());
}

TEST(RotationHypotheses, OfARoundRoomThatFavoursNoneAreFinite) {
  TangentHistogram even{};
  even.fill(1.0);
  for (const double rotation_rad : rotation_hypotheses(even, even, 8)) EXPECT_TRUE(std::isfinite(rotation_rad));
}

}  // namespace
}  // namespace shapemap
