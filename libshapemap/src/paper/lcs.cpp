// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/paper/lcs.hpp"

#include <algorithm>

namespace shapemap {
namespace {

using Word = BitMatrix::Word;

/// With L(i, j) the length for the first i rows and j columns: bit j of `after` is 0 where L(i, j + 1) is one more than
/// L(i, j). `before` is the same for one row less.
void advance_row(const Word* before, const Word* matches, std::size_t words, Word* after) {
  Word carry = 0;
  for (std::size_t w = 0; w < words; ++w) {
    const Word v = before[w];
    const Word u = v & matches[w];
    const Word sum = v + u;
    const Word with_carry = sum + carry;
    carry = static_cast<Word>(sum < v) | static_cast<Word>(with_carry < sum);
    after[w] = with_carry | (v & ~matches[w]);
  }
}

}  // namespace

std::vector<IndexPair> longest_common_subsequence(const BitMatrix& matches) {
  // Row i of `no_step` holds the bits after i rows of `matches`.
  BitMatrix no_step(matches.rows() + 1, matches.columns());
  const std::size_t words = matches.words_per_row();
  std::fill(no_step.row(0), no_step.row(0) + words, ~Word{0});
  for (std::size_t i = 0; i < matches.rows(); ++i)
    advance_row(no_step.row(i), matches.row(i), words, no_step.row(i + 1));

  std::vector<IndexPair> pairs;
  std::size_t i = matches.rows();
  std::size_t j = matches.columns();
  while (i > 0 && j > 0) {
    if (no_step.test(i, j - 1)) {
      --j;  // the last column adds nothing
    } else if (!no_step.test(i - 1, j - 1)) {
      --i;  // the last row adds nothing: both rows step here, and L grows by one at most along a diagonal
    } else {
      pairs.push_back({--i, --j});
    }
  }
  std::reverse(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace shapemap
