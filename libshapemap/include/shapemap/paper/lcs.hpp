// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "shapemap/paper/similarity.hpp"

/// Paper, section II-C: the longest common subsequence (LCS) of the points of two scans.
namespace shapemap {

/// A row and a column of a matrix that says which points are similar.
struct IndexPair {
  std::size_t query = 0;
  std::size_t target = 0;
};

inline bool operator==(const IndexPair& a, const IndexPair& b) { return a.query == b.query && a.target == b.target; }

/// Returns a longest list of pairs whose bits are set and in which both indices ascend. The table is computed
/// bit-parallel (Hyyro, "Bit-parallel LCS-length computation revisited", 2004): a row of 64 columns takes a few
/// instructions. All rows are kept to trace one subsequence back, at one bit per cell.
std::vector<IndexPair> longest_common_subsequence(const BitMatrix& matches);

}  // namespace shapemap
