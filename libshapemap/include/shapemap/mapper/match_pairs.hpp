// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "shapemap/core/observer.hpp"
#include "shapemap/core/pose2.hpp"
#include "shapemap/mapper/mapper_options.hpp"
#include "shapemap/matching/scan_match.hpp"
#include "shapemap/scan/scan.hpp"

/// Many pairs of scans are matched by the robust method, each pair by itself, without the help of neighbouring scans.
namespace shapemap {

/// A pair of scans; each index counts the scans of its own log.
struct ScanPair {
  std::size_t reference = 0;
  std::size_t query = 0;
  std::optional<Pose2> given_ref_from_query;  ///< a pose that is judged as well, and never used by the search
};

struct AlignedPair {
  ScanPair pair;
  ScanMatch match;
  std::optional<RankedPose> given;    ///< the given pose as it is, where there is one and both scans have shape
  std::optional<RankedPose> refined;  ///< the given pose after refinement
  double seconds = 0.0;               ///< time of the match, without that of the views
};

/// Returns all pairs of a scan and the scan `gap` after it.
std::vector<ScanPair> pairs_with_gap(std::size_t num_scans, std::size_t gap);

/// Returns one result for each of `pairs`, in their order; `references` and `queries` may be the same log. The same
/// input and options give the same bits, except for the seconds, for any number of threads. Throws ConfigError for bad
/// options and for an index beyond its log, InputError for a scan that no sensor can have recorded, and Interrupted
/// when the observer asks to stop; it never throws for scans that do not match.
std::vector<AlignedPair> align_pairs(const Log& references, const Log& queries, const std::vector<ScanPair>& pairs,
                                     const MappingOptions& options, RunObserver& observer);

}  // namespace shapemap
