// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// What was done so that the times of a recording increase.
struct TimestampRepairs {
  bool all_replaced = false;         ///< all were equal; the index in seconds is taken
  std::size_t num_sorted = 0;        ///< positions that stood a few places from where their time belongs
  std::size_t num_interpolated = 0;  ///< single times that cannot be, and repeated ones
  std::size_t num_set_back = 0;      ///< places where the clock went back; all after it is moved on

  /// A line for each kind of repair; none when the times were right.
  std::vector<std::string> lines() const;
};

/// Makes the times of one recording increase strictly, and changes nothing of one whose times do.
///
/// - Equal times throughout say nothing: the index in seconds is taken.
/// - Positions that lie at most three places from where their time belongs were swapped by a buffer and are sorted.
/// - A single time between two that go together, but not between them in time, is interpolated.
/// - Elsewhere a clock was set back: the order of the file stays, and times go on by the usual step.
/// - Of times that repeat, the first stays; the others are spread up to the next time.
TimestampRepairs mend_timestamps(std::vector<Position>& positions);

}  // namespace shapemap
