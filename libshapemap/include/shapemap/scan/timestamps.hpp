// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// These repairs made the times of a recording increase.
struct TimestampRepairs {
  bool all_replaced = false;         ///< the times say nothing; the index in seconds replaces them
  std::size_t num_sorted = 0;        ///< scans that stood a few places from where their time belongs
  std::size_t num_interpolated = 0;  ///< times that do not fit those around them, and repeated ones
  std::size_t num_set_back = 0;      ///< places where the clock went back; all later times are moved on

  /// Returns a line for each kind of repair; none when the times were right.
  std::vector<std::string> lines() const;
};

/// Makes the times of one recording increase strictly; a recording whose times do so already stays unchanged.
///
/// - Times of which more than half are the same say nothing: the index in seconds replaces them.
/// - Scans that lie at most three places from where their time belongs are sorted if they then change less from one to
///   the next. If not, the order of the log is right, and some times were stamped late.
/// - Up to ten times in a row that do not fit into the sequence of the others are interpolated.
/// - Elsewhere a clock was set back: the order of the log stays, and times go on by the usual step.
/// - Of times that repeat, the first stays; the others are spread up to the next time.
TimestampRepairs mend_timestamps(std::vector<Scan>& scans);

}  // namespace shapemap
