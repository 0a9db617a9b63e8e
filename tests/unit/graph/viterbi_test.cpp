// SPDX-License-Identifier: GPL-3.0-or-later
#include "graph/viterbi.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <random>

namespace shapemap {
namespace {

constexpr double kFullMargin = 20.0;

ViterbiChain random_chain(std::mt19937& rng, std::size_t num_edges, std::size_t most_alternatives, double spread) {
  std::uniform_real_distribution<double> value(-spread, spread);
  std::uniform_int_distribution<std::size_t> count(1, most_alternatives);
  ViterbiChain chain;
  chain.scores.resize(num_edges);
  chain.transition_scores.resize(num_edges);
  for (std::vector<double>& scores : chain.scores) {
    scores.resize(count(rng));
    for (double& score : scores) score = value(rng);
  }
  for (std::size_t edge = 0; edge + 1 < num_edges; ++edge) {
    chain.transition_scores[edge].assign(chain.scores[edge].size(), std::vector<double>(chain.scores[edge + 1].size()));
    for (std::vector<double>& row : chain.transition_scores[edge]) {
      for (double& transition_scores : row) transition_scores = value(rng);
    }
  }
  return chain;
}

double sum_of(const ViterbiChain& chain, const std::vector<std::size_t>& taken) {
  double sum = 0.0;
  for (std::size_t edge = 0; edge < taken.size(); ++edge) {
    sum += chain.scores[edge][taken[edge]];
    if (edge + 1 < taken.size()) sum += chain.transition_scores[edge][taken[edge]][taken[edge + 1]];
  }
  return sum;
}

/// Goes on to the next combination of candidates, like a counter, and returns false after the last.
bool advance(const ViterbiChain& chain, std::vector<std::size_t>& taken) {
  for (std::size_t edge = 0; edge < taken.size(); ++edge) {
    if (++taken[edge] < chain.scores[edge].size()) return true;
    taken[edge] = 0;
  }
  return false;
}

/// Returns the best choices and their margins from the sums of all combinations.
std::vector<Choice> by_enumeration(const ViterbiChain& chain) {
  constexpr double kNever = -std::numeric_limits<double>::infinity();
  std::vector<std::vector<double>> best;  // [edge][candidate]: best sum of the sequences with it
  for (const std::vector<double>& scores : chain.scores) best.emplace_back(scores.size(), kNever);
  std::vector<std::size_t> taken(chain.scores.size(), 0);
  do {
    const double sum = sum_of(chain, taken);
    for (std::size_t edge = 0; edge < taken.size(); ++edge) {
      best[edge][taken[edge]] = std::max(best[edge][taken[edge]], sum);
    }
  } while (advance(chain, taken));
  std::vector<Choice> choices;
  for (const std::vector<double>& sums : best) {
    Choice choice;
    choice.candidate = static_cast<std::size_t>(std::max_element(sums.begin(), sums.end()) - sums.begin());
    choice.margin = kFullMargin;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      choice.behind.push_back(sums[choice.candidate] - sums[i]);
      if (i != choice.candidate) choice.margin = std::min(choice.margin, choice.behind.back());
    }
    choices.push_back(choice);
  }
  return choices;
}

TEST(Viterbi, GivesThoseOfAllCombinations) {
  std::mt19937 rng(1);
  for (int round = 0; round < 500; ++round) {
    const std::size_t num_edges = 1 + static_cast<std::size_t>(round) % 6;
    const double spread = round % 3 == 0 ? 30.0 : 3.0;  // Some margins are beyond the full one.
    const ViterbiChain chain = random_chain(rng, num_edges, 4, spread);
    const std::vector<Choice> expected = by_enumeration(chain);
    const std::vector<Choice> found = viterbi(chain, kFullMargin);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t edge = 0; edge < found.size(); ++edge) {
      EXPECT_EQ(found[edge].candidate, expected[edge].candidate) << round;
      EXPECT_NEAR(found[edge].margin, expected[edge].margin, 1e-9) << round;
      EXPECT_THAT(found[edge].behind, ::testing::Pointwise(::testing::DoubleNear(1e-9), expected[edge].behind));
    }
  }
}

TEST(Viterbi, GivesOneSequenceWithTheLargestSum) {
  std::mt19937 rng(2);
  for (int round = 0; round < 200; ++round) {
    const ViterbiChain chain = random_chain(rng, 5, 4, 3.0);
    std::vector<std::size_t> found;
    for (const Choice& choice : viterbi(chain, kFullMargin)) found.push_back(choice.candidate);
    double largest = -std::numeric_limits<double>::infinity();
    std::vector<std::size_t> taken(5, 0);
    do largest = std::max(largest, sum_of(chain, taken));
    while (advance(chain, taken));
    EXPECT_NEAR(sum_of(chain, found), largest, 1e-9);
  }
}

TEST(Viterbi, GivesATieNoMarginAndTakesTheFirst) {
  ViterbiChain chain;
  chain.scores = {{1.0, 1.0, 0.5}};
  chain.transition_scores.resize(1);
  const std::vector<Choice> choices = viterbi(chain, kFullMargin);
  ASSERT_EQ(choices.size(), 1U);
  EXPECT_EQ(choices[0].candidate, 0U);
  EXPECT_EQ(choices[0].margin, 0.0);
}

TEST(Viterbi, GivesASingleCandidateTheFullMargin) {
  ViterbiChain chain;
  chain.scores = {{-5.0}};
  chain.transition_scores.resize(1);
  EXPECT_EQ(viterbi(chain, 7.0)[0].margin, 7.0);
  EXPECT_TRUE(viterbi({}, 7.0).empty());
}

TEST(Viterbi, IsFastForALongSequence) {
  std::mt19937 rng(3);
  EXPECT_EQ(viterbi(random_chain(rng, 20000, 7, 3.0), kFullMargin).size(), 20000U);
}

}  // namespace
}  // namespace shapemap
