// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "shapemap/scan/placed_scan.hpp"
#include "shapemap/scan/returns.hpp"
#include "shapemap/scan/scan.hpp"

/// Each scan of a finished map is compared with the map that the others make: tilted scans, crowds and scans in the
/// wrong place are inconsistent with it.
namespace shapemap {

struct ConsistencyOptions {
  double cell_m = 0.10;
  double tolerance_m = 0.10;
  int min_visits = 2;
  double contradicting_share = 0.15;
  double min_known_share = 0.2;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit(Field{"consistency-cell-m", "side of the cells in which scans are compared with the others' map [m]", 0.01, 1}
              .formerly("agreement-cell-m"),
          self.cell_m);
    visit(Field{"consistency-tolerance-m", "so far off its place a surface is still the same [m]", 0, 1}.formerly(
              "agreement-tolerance-m"),
          self.tolerance_m);
    visit(Field{"consistency-min-visits", "so many visits from elsewhere must see it otherwise", 1, 1000}.formerly(
              "agreement-min-looks"),
          self.min_visits);
    visit(
        Field{"contradicting-share", "a scan contradicts the map when more of its known beams do; 1: none does", 0, 1},
        self.contradicting_share);
    visit(Field{"contradicting-min-known", "and at least this share of its beams ends where others have looked", 0, 1},
          self.min_known_share);
  }
};

/// Returns the consistency of each of `placed`, in their order. Scans that follow each other within 0.5 m and 20
/// degrees make one visit, and scans of a visit are no evidence about each other: they may lean, or stand in the same
/// crowd, together. Time is linear in the number of beams, and memory in the area that was seen. Poses too far off for
/// any map are left out, with no beams known. Throws ConfigError when an option is out of its range.
std::vector<ScanConsistency> scan_consistencies(const std::vector<Scan>& scans, const std::vector<PlacedScan>& placed,
                                                const ReturnOptions& returns, const ConsistencyOptions& options);

/// Writes the consistency into all placed scans; each component is judged by itself.
void judge_consistency(const std::vector<Scan>& scans, const ReturnOptions& returns, const ConsistencyOptions& options,
                       std::vector<Component>& components);

}  // namespace shapemap
