// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/mapper/match_pairs.hpp"

/// Which pairs of positions to align, and what came of it, as files.
namespace shapemap {

/// Lines `i j` or `i j x_m y_m theta_rad`, the latter with a pose of j in the frame of i; `#` begins a remark. Throws
/// InputError naming file and line, also for an index that is not below its number of positions, and when there is no
/// pair at all.
std::vector<ScanPair> read_pairs(const std::string& path, std::size_t num_references, std::size_t num_queries);

/// One JSON object and a line end; see docs/cli.md for its members. What is not a number is null.
std::string json_line(const AlignedPair& pair, bool with_seconds);

}  // namespace shapemap
