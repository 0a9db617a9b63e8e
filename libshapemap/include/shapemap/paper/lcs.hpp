// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/paper/similarity.hpp"

namespace shapemap {

/// A row and a column of a match matrix.
struct IndexPair {
  std::size_t query = 0;
  std::size_t target = 0;
};

inline bool operator==(const IndexPair& a, const IndexPair& b) { return a.query == b.query && a.target == b.target; }

/// A longest common subsequence of rows and columns (paper, section II-C): the longest list of pairs whose bits are set
/// and in which both indices ascend. Bit-parallel (Hyyro, "Bit-parallel LCS-length computation revisited", 2004): a
/// row of 64 columns takes a few instructions; all rows are kept to trace one subsequence back, at one bit per cell.
std::vector<IndexPair> longest_common_subsequence(const BitMatrix& matches);

}  // namespace shapemap
