// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace shapemap {

/// What all other pairs of scans of two pieces say of a place, by MapScore. They do not tell independently of each
/// other, so only the balance counts.
struct EdgeSupport {
  double for_it = 0.0;
  double against_it = 0.0;

  void add(double evidence) { (evidence > 0.0 ? for_it : against_it) += evidence > 0.0 ? evidence : -evidence; }

  /// -1: all against it, 0: nothing said, 1: all for it.
  double value() const;
};

}  // namespace shapemap
