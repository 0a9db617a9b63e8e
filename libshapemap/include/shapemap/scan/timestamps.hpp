// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// What was done so that the times of a recording increase.
struct TimestampRepairs {
  bool all_replaced = false;         ///< they say nothing; the index in seconds is taken
  std::size_t num_sorted = 0;        ///< positions that stood a few places from where their time belongs
  std::size_t num_interpolated = 0;  ///< times that do not fit those around them, and repeated ones
  std::size_t num_set_back = 0;      ///< places where the clock went back; all after it is moved on

  /// A line for each kind of repair; none when the times were right.
  std::vector<std::string> lines() const;
};

/// Makes the times of one recording increase strictly, and changes nothing of one whose times do.
///
/// - Times of which more than half are the same say nothing: the index in seconds is taken.
/// - Positions that lie at most three places from where their time belongs are sorted if the scans then change less
///   from one to the next. If not, the order of the log is right, and some times were stamped late.
/// - Up to ten times in a row that do not fit into the sequence of the others are interpolated.
/// - Elsewhere a clock was set back: the order of the log stays, and times go on by the usual step.
/// - Of times that repeat, the first stays; the others are spread up to the next time.
TimestampRepairs mend_timestamps(std::vector<Scan>& scans);

}  // namespace shapemap
