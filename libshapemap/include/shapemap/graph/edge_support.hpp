// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace shapemap {

/// The evidence for and against a candidate, by MapScore, of all other pairs of scans of the two submaps. The pairs are
/// not independent, so only the balance of both counts.
struct EdgeSupport {
  double for_it = 0.0;
  double against_it = 0.0;

  void add(double evidence) { (evidence > 0.0 ? for_it : against_it) += evidence > 0.0 ? evidence : -evidence; }

  /// Returns the balance, from -1 (all evidence is against it) over 0 (there is none) to 1 (all is for it).
  double value() const;
};

}  // namespace shapemap
