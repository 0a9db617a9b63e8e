// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/lcs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace shapemap {
namespace {

/// The textbook recurrence.
std::size_t length_by_dynamic_programming(const BitMatrix& matches) {
  std::vector<std::size_t> above(matches.columns() + 1, 0);
  for (std::size_t i = 0; i < matches.rows(); ++i) {
    std::vector<std::size_t> here(matches.columns() + 1, 0);
    for (std::size_t j = 0; j < matches.columns(); ++j) {
      here[j + 1] = matches.test(i, j) ? above[j] + 1 : std::max(above[j + 1], here[j]);
    }
    above = here;
  }
  return above.back();
}

BitMatrix random_matrix(std::size_t rows, std::size_t columns, double density, std::mt19937& rng) {
  BitMatrix matrix(rows, columns);
  std::bernoulli_distribution is_set(density);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      if (is_set(rng)) matrix.set(i, j);
    }
  }
  return matrix;
}

void expect_is_longest(const BitMatrix& matches) {
  const std::vector<IndexPair> pairs = longest_common_subsequence(matches);
  ASSERT_EQ(pairs.size(), length_by_dynamic_programming(matches));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    ASSERT_LT(pairs[k].query, matches.rows());
    ASSERT_LT(pairs[k].target, matches.columns());
    ASSERT_TRUE(matches.test(pairs[k].query, pairs[k].target));
    if (k == 0) continue;
    ASSERT_LT(pairs[k - 1].query, pairs[k].query);
    ASSERT_LT(pairs[k - 1].target, pairs[k].target);
  }
}

TEST(Lcs, IsAsLongAsDynamicProgrammingFindsOnSmallMatrices) {
  std::mt19937 rng(1);
  std::uniform_int_distribution<std::size_t> side(0, 24);
  std::uniform_real_distribution<double> density(0.0, 1.0);
  for (int k = 0; k < 4000; ++k) {
    const std::size_t rows = side(rng);
    const std::size_t columns = side(rng);
    expect_is_longest(random_matrix(rows, columns, density(rng), rng));
    if (HasFatalFailure()) FAIL() << "matrix " << k;
  }
}

TEST(Lcs, IsAsLongAsDynamicProgrammingFindsAcrossSeveralWords) {
  std::mt19937 rng(2);
  std::uniform_int_distribution<std::size_t> side(0, 200);
  std::uniform_real_distribution<double> density(0.0, 1.0);
  for (int k = 0; k < 200; ++k) {
    const std::size_t rows = side(rng);
    const std::size_t columns = side(rng);
    const double share = density(rng);
    expect_is_longest(random_matrix(rows, columns, share * share, rng));  // sparse ones are the harder
    if (HasFatalFailure()) FAIL() << "matrix " << k;
  }
}

TEST(Lcs, IsRightAtTheEdgesOfWords) {
  std::mt19937 rng(3);
  for (const std::size_t columns : {1U, 63U, 64U, 65U, 127U, 128U, 129U, 192U}) {
    for (const double density : {0.02, 0.2, 0.7}) {
      expect_is_longest(random_matrix(90, columns, density, rng));
      expect_is_longest(random_matrix(columns, 90, density, rng));
      if (HasFatalFailure()) FAIL() << columns << " columns, density " << density;
    }
  }
}

TEST(Lcs, OfAnEmptyMatrixIsEmpty) {
  EXPECT_TRUE(longest_common_subsequence(BitMatrix(0, 0)).empty());
  EXPECT_TRUE(longest_common_subsequence(BitMatrix(0, 70)).empty());
  EXPECT_TRUE(longest_common_subsequence(BitMatrix(70, 0)).empty());
}

TEST(Lcs, WithoutMatchesIsEmpty) { EXPECT_TRUE(longest_common_subsequence(BitMatrix(130, 70)).empty()); }

TEST(Lcs, WhereEverythingMatchesIsAsLongAsTheShorterSide) {
  for (const auto& [rows, columns] : {std::pair<std::size_t, std::size_t>{70, 130}, {130, 70}, {64, 64}, {1, 200}}) {
    BitMatrix all(rows, columns);
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t j = 0; j < columns; ++j) all.set(i, j);
    }
    expect_is_longest(all);
    EXPECT_EQ(longest_common_subsequence(all).size(), std::min(rows, columns));
  }
}

TEST(Lcs, OfTheIdentityIsTheDiagonal) {
  BitMatrix identity(150, 150);
  for (std::size_t i = 0; i < 150; ++i) identity.set(i, i);
  const std::vector<IndexPair> pairs = longest_common_subsequence(identity);
  ASSERT_EQ(pairs.size(), 150U);
  for (std::size_t i = 0; i < 150; ++i) EXPECT_EQ(pairs[i], (IndexPair{i, i}));
}

TEST(Lcs, OfAReversedSequenceIsOnePair) {
  BitMatrix reversed(100, 100);
  for (std::size_t i = 0; i < 100; ++i) reversed.set(i, 99 - i);
  EXPECT_EQ(longest_common_subsequence(reversed).size(), 1U);
}

TEST(Lcs, GivesTheSamePairsEachTime) {
  std::mt19937 rng(4);
  const BitMatrix matrix = random_matrix(150, 170, 0.3, rng);
  const std::vector<IndexPair> first = longest_common_subsequence(matrix);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(longest_common_subsequence(matrix), first);
}

}  // namespace
}  // namespace shapemap
