// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/mapper/match_pairs.hpp"

/// These functions read the pairs of scans to match, and write the results.
namespace shapemap {

/// Reads lines `i j` or `i j x_m y_m theta_rad`, the latter with a pose of j in the frame of i; `#` begins a remark.
/// Throws InputError, which names file and line, also for an index that is not below its number of scans, and when
/// there is no pair at all.
std::vector<ScanPair> read_pairs(const std::string& path, std::size_t num_references, std::size_t num_queries);

/// Returns one JSON object and a line end; docs/cli.md describes its members. Numbers that are not finite become null.
std::string json_line(const AlignedPair& pair, bool with_seconds);

}  // namespace shapemap
