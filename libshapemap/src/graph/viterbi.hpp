// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace shapemap {

/// A sequence of edges, each of which takes one of its candidates. Pairs of candidates of neighbouring edges have
/// scores as well.
struct ViterbiChain {
  std::vector<std::vector<double>> scores;  ///< [edge][candidate]; each edge has at least one candidate
  std::vector<std::vector<std::vector<double>>> transition_scores;  ///< [edge][candidate][candidate of the next edge]
};

struct Choice {
  std::size_t candidate = 0;
  double margin = 0.0;         ///< score of the best sequence with this candidate minus the best without it
  std::vector<double> behind;  ///< of each candidate: score of the best sequence minus the best with it
};

/// Returns the sequence of candidates with the largest sum of scores (Viterbi 1967). `full_margin` is the margin of an
/// edge with only one candidate, and the largest margin.
std::vector<Choice> viterbi(const ViterbiChain& chain, double full_margin);

}  // namespace shapemap
