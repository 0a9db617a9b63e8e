// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace shapemap {

/// A chain of choices: each link takes one of its alternatives, and neighbouring links may go together well or badly.
struct ViterbiChain {
  std::vector<std::vector<double>> scores;  ///< [link][alternative]; no link is without alternatives
  std::vector<std::vector<std::vector<double>>>
      transition_scores;  ///< [link][alternative][alternative of the next link]
};

struct Choice {
  std::size_t candidate = 0;
  double margin = 0.0;         ///< what the best chain with this alternative is better by than the best without it
  std::vector<double> behind;  ///< per alternative: what the best chain of all is better by than the best with it
};

/// The chain with the largest sum (Viterbi 1967), and how much each of its choices matters. `full_margin` is the margin
/// of a link with one alternative only.
std::vector<Choice> viterbi(const ViterbiChain& chain, double full_margin);

}  // namespace shapemap
