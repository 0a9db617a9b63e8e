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

/// Many alignments by the robust method, each of two positions alone, without a chain that helps.
namespace shapemap {

/// Each index is into the positions of its own log.
struct ScanPair {
  std::size_t reference = 0;
  std::size_t query = 0;
  std::optional<Pose2> given_ref_from_query;  ///< judged beside what is found, and never used to find it
};

struct AlignedPair {
  ScanPair pair;
  ScanMatch match;
  std::optional<RankedPose> given;    ///< the given pose as it is; nothing without one, or without shape
  std::optional<RankedPose> refined;  ///< the same, refined from there
  double seconds = 0.0;               ///< for `alignment`, without the views
};

/// All pairs of a position and the one `gap` after it.
std::vector<ScanPair> pairs_with_gap(std::size_t num_scans, std::size_t gap);

/// One result for each of `pairs`, in their order; `references` and `queries` may be the same log. Same input and
/// options give the same bits, but for the seconds, for any number of threads. Throws ConfigError for bad options and
/// for an index beyond its log, InputError for a position that no sensor can have recorded, Interrupted when the
/// observer asks to stop; never for scans that do not match.
std::vector<AlignedPair> align_pairs(const Log& references, const Log& queries, const std::vector<ScanPair>& pairs,
                                     const MappingOptions& options, RunObserver& observer);

}  // namespace shapemap
