// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/similarity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace shapemap {
namespace {

constexpr SimilarityOptions kPaper{10 * kDegree, 0.25, 2};

/// Few distinct levels and tangents, among them those at the seam, so that near misses abound.
ScanFeatures random_features(std::size_t count, std::mt19937& rng) {
  std::uniform_real_distribution<double> any_rad(-kPi, kPi);
  std::uniform_int_distribution<int> percent(0, 99);
  const std::array<std::uint8_t, 6> levels{0, 1, 62, 63, 64, 252};
  ScanFeatures features;
  for (std::size_t i = 0; i < count; ++i) {
    const int kind = percent(rng);
    features.tangents_rad.push_back(kind < 10 ? kPi : kind < 20 ? -kPi : any_rad(rng));
    AngularHistogram histogram;
    const int empty_percent = percent(rng);
    for (std::uint8_t& bin : histogram.bins) {
      if (percent(rng) >= empty_percent) bin = levels.at(static_cast<std::size_t>(percent(rng)) % levels.size());
    }
    features.histograms.push_back(histogram);
  }
  return features;
}

/// The paper's definition, pair by pair, in numbers from 0 to 1.
bool are_similar(const ScanFeatures& a, std::size_t i, const ScanFeatures& b, std::size_t j,
                 const SimilarityOptions& options) {
  double turn_rad = std::abs(a.tangents_rad[i] - b.tangents_rad[j]);
  turn_rad = std::min(turn_rad, 2 * kPi - turn_rad);
  if (turn_rad > options.tangent_tolerance_rad + 1e-12) return false;
  int differing = 0;
  for (std::size_t bin = 0; bin < kHistogramBins; ++bin) {
    const double in_a = a.histograms[i].bins[bin] / kHistogramScale;
    const double in_b = b.histograms[j].bins[bin] / kHistogramScale;
    if (std::abs(in_a - in_b) > options.bin_tolerance + 1e-9) ++differing;
  }
  return differing <= options.max_differing_bins;
}

/// Compares all bits with the definition; returns how many are set.
std::size_t expect_definition(const ScanFeatures& query, const ScanFeatures& target, const SimilarityOptions& options) {
  const BitMatrix found = SimilarityIndex(target, options).matches(query);
  EXPECT_EQ(found.rows(), query.size());
  EXPECT_EQ(found.columns(), target.size());
  std::size_t num_similar = 0;
  for (std::size_t i = 0; i < query.size(); ++i) {
    for (std::size_t j = 0; j < target.size(); ++j) {
      const bool expected = are_similar(query, i, target, j, options);
      num_similar += expected ? 1 : 0;
      EXPECT_EQ(found.test(i, j), expected) << i << ", " << j;
    }
  }
  return num_similar;
}

ScanFeatures one_point(double tangent_rad, const std::vector<std::pair<std::size_t, int>>& bins = {}) {
  ScanFeatures features{{tangent_rad}, {AngularHistogram{}}};
  for (const auto& [bin, level] : bins) features.histograms[0].bins.at(bin) = static_cast<std::uint8_t>(level);
  return features;
}

bool similar(const ScanFeatures& a, const ScanFeatures& b, const SimilarityOptions& options = kPaper) {
  return SimilarityIndex(a, options).matches(b).test(0, 0);
}

TEST(Similarity, EqualsTheDefinitionForAnyNumberOfDifferingBins) {
  std::mt19937 rng(1);
  std::size_t num_similar = 0;
  for (int differing = 0; differing <= 36; ++differing) {
    const ScanFeatures query = random_features(40, rng);
    const ScanFeatures target = random_features(50, rng);
    num_similar += expect_definition(query, target, {60 * kDegree, 0.25, differing});
  }
  EXPECT_GT(num_similar, 1000U);
}

TEST(Similarity, EqualsTheDefinitionForAnyTangentTolerance) {
  std::mt19937 rng(2);
  for (const double tolerance_deg : {0.0, 0.1, 10.0, 89.0, 179.0, 180.0}) {
    const ScanFeatures query = random_features(60, rng);
    const ScanFeatures target = random_features(60, rng);
    EXPECT_GT(expect_definition(query, target, {tolerance_deg * kDegree, 0.25, 30}), 0U) << tolerance_deg;
  }
}

TEST(Similarity, EqualsTheDefinitionForAnyBinTolerance) {
  std::mt19937 rng(3);
  for (const double tolerance : {0.0, 1.0 / 252, 0.1, 0.249, 0.25, 0.251, 0.5, 0.999, 1.0}) {
    const ScanFeatures query = random_features(50, rng);
    const ScanFeatures target = random_features(50, rng);
    EXPECT_GT(expect_definition(query, target, {40 * kDegree, tolerance, 15}), 0U) << tolerance;
  }
}

TEST(Similarity, EqualsTheDefinitionForAnyNumberOfPoints) {
  std::mt19937 rng(4);
  for (const std::size_t count : {1U, 63U, 64U, 65U, 127U, 128U, 129U, 200U}) {
    const ScanFeatures query = random_features(7, rng);
    const ScanFeatures target = random_features(count, rng);
    expect_definition(query, target, {90 * kDegree, 0.25, 20});
    expect_definition(target, query, {90 * kDegree, 0.25, 20});
  }
}

TEST(Similarity, LeavesBitsBeyondTheLastColumnEmpty) {
  const ScanFeatures alike{std::vector<double>(70, 0.0), std::vector<AngularHistogram>(70)};
  const BitMatrix bits = SimilarityIndex(alike, kPaper).matches(alike);
  ASSERT_EQ(bits.words_per_row(), 2U);
  for (std::size_t r = 0; r < bits.rows(); ++r) {
    EXPECT_EQ(bits.row(r)[0], ~BitMatrix::Word{0});
    EXPECT_EQ(bits.row(r)[1], BitMatrix::Word{0x3F});
  }
}

TEST(Similarity, OfEmptyScansIsAnEmptyMatrix) {
  const ScanFeatures some = one_point(0.0);
  const BitMatrix no_target = SimilarityIndex({}, kPaper).matches(some);
  EXPECT_EQ(no_target.rows(), 1U);
  EXPECT_EQ(no_target.columns(), 0U);
  const BitMatrix no_query = SimilarityIndex(some, kPaper).matches({});
  EXPECT_EQ(no_query.rows(), 0U);
  EXPECT_EQ(no_query.columns(), 1U);
}

TEST(Similarity, TangentsAreComparedAcrossTheSeam) {
  EXPECT_TRUE(similar(one_point(176 * kDegree), one_point(-176 * kDegree)));
  EXPECT_TRUE(similar(one_point(-176 * kDegree), one_point(176 * kDegree)));
  EXPECT_FALSE(similar(one_point(174 * kDegree), one_point(-175 * kDegree)));
}

TEST(Similarity, OppositeTangentsAreNotSimilar) {
  EXPECT_FALSE(similar(one_point(0.0), one_point(kPi)));
  EXPECT_FALSE(similar(one_point(-kPi / 2), one_point(kPi / 2)));
}

TEST(Similarity, AQuarterApartIsTheSameBinAndMoreIsNot) {
  const SimilarityOptions strict{10 * kDegree, 0.25, 0};
  EXPECT_TRUE(similar(one_point(0.0, {{5, 100}}), one_point(0.0, {{5, 163}}), strict));
  EXPECT_FALSE(similar(one_point(0.0, {{5, 100}}), one_point(0.0, {{5, 164}}), strict));
  EXPECT_TRUE(similar(one_point(0.0, {{5, 63}}), one_point(0.0), strict));
  EXPECT_FALSE(similar(one_point(0.0, {{5, 64}}), one_point(0.0), strict));
}

TEST(Similarity, TwoDifferingBinsAreSimilarAndThreeAreNot) {
  const ScanFeatures empty = one_point(0.0);
  EXPECT_TRUE(similar(empty, one_point(0.0, {{0, 252}, {35, 252}})));
  EXPECT_FALSE(similar(empty, one_point(0.0, {{0, 252}, {17, 252}, {35, 252}})));
}

TEST(ScanFeatures, TurnTangentsAndHistogramsTogether) {
  Shape shape;
  shape.points = {{{0.0, 0.0}, 170 * kDegree, 0}, {rotate({0.2, 0.0}, 5 * kDegree), -170 * kDegree, 0}};
  const NeighbourDirections directions(shape, 0.5);
  const ScanFeatures features = features_of(shape, directions, 20 * kDegree, HistogramNorm::kMaximum);
  ASSERT_EQ(features.size(), 2U);
  EXPECT_NEAR(features.tangents_rad[0], -170 * kDegree, 1e-12);
  EXPECT_NEAR(features.tangents_rad[1], -150 * kDegree, 1e-12);
  EXPECT_EQ(features.histograms[0].bins[2], 252);   // 5 + 20 degrees
  EXPECT_EQ(features.histograms[1].bins[20], 252);  // 185 + 20
}

}  // namespace
}  // namespace shapemap
