// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <vector>

namespace shapemap {

/// Finds from the readings of a whole log where "no return" begins, for logs that do not say it.
///
/// A laser or its driver reports "nothing hit" as one special distance. Two kinds exist in CARMEN logs:
/// - SICK error codes: the largest 13-bit numbers, 8183 to 8191, in the laser's unit of 1 cm or 4 mm (the latter
///   are 32.73 to 32.77 m). In the 1 cm unit, the laser's limit is 81 m: from there on nothing is a distance.
/// - The driver's own limit: a round number of decimetres (50.0, 51.2, 20.0 ...) that cuts off what is longer.
/// A level below 81 m is believed only if it is the top of the log, at least ten readings lie on it, and more than
/// five times as many as in the 1 % below it. Walls fail this: seen from a moving robot, or even by a standing one
/// with noise and neighbouring beams, their distances spread. Nothing below 7.9 m is tried, so that a small room
/// drawn by hand stays what it is.
class NoReturnLevel {
 public:
  void add(const std::vector<float>& ranges_m);
  /// Readings from here on are no returns.
  double max_range_m() const;

 private:
  std::map<float, std::size_t> far_readings_;  ///< how often each distance occurs
};

}  // namespace shapemap
