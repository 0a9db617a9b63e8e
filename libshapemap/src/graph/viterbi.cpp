// SPDX-License-Identifier: GPL-3.0-or-later
#include "viterbi.hpp"

#include <algorithm>
#include <limits>

namespace shapemap {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

/// The largest sum of scores of all edges on one side of each candidate, without its own score.
using Sums = std::vector<std::vector<double>>;

Sums empty_sums(const ViterbiChain& chain) {
  Sums sums;
  for (const std::vector<double>& scores : chain.scores) sums.emplace_back(scores.size(), 0.0);
  return sums;
}

Sums sums_before(const ViterbiChain& chain) {
  Sums sums = empty_sums(chain);
  for (std::size_t edge = 1; edge < sums.size(); ++edge) {
    for (std::size_t to = 0; to < sums[edge].size(); ++to) {
      double best = kNever;
      for (std::size_t from = 0; from < sums[edge - 1].size(); ++from) {
        best = std::max(
            best, sums[edge - 1][from] + chain.scores[edge - 1][from] + chain.transition_scores[edge - 1][from][to]);
      }
      sums[edge][to] = best;
    }
  }
  return sums;
}

Sums sums_after(const ViterbiChain& chain) {
  Sums sums = empty_sums(chain);
  for (std::size_t edge = sums.size(); edge-- > 1;) {
    for (std::size_t from = 0; from < sums[edge - 1].size(); ++from) {
      double best = kNever;
      for (std::size_t to = 0; to < sums[edge].size(); ++to) {
        best = std::max(best, sums[edge][to] + chain.scores[edge][to] + chain.transition_scores[edge - 1][from][to]);
      }
      sums[edge - 1][from] = best;
    }
  }
  return sums;
}

}  // namespace

std::vector<Choice> viterbi(const ViterbiChain& chain, double full_margin) {
  const Sums before = sums_before(chain);
  const Sums after = sums_after(chain);
  std::vector<Choice> choices;
  for (std::size_t edge = 0; edge < chain.scores.size(); ++edge) {
    std::vector<double> sums;
    for (std::size_t i = 0; i < chain.scores[edge].size(); ++i) {
      sums.push_back(before[edge][i] + chain.scores[edge][i] + after[edge][i]);
    }
    const auto best = std::max_element(sums.begin(), sums.end());
    Choice choice;
    choice.candidate = static_cast<std::size_t>(best - sums.begin());
    choice.margin = full_margin;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      choice.behind.push_back(*best - sums[i]);
      if (i != choice.candidate) choice.margin = std::min(choice.margin, choice.behind.back());
    }
    choices.push_back(std::move(choice));
  }
  return choices;
}

}  // namespace shapemap
