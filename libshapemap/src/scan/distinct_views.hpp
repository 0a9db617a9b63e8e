// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "level_test.hpp"
#include "range_sample.hpp"

namespace shapemap {

/// Adds up the weights of range segments inside of a window of distances and on both sides of it, counting each view
/// once.
///
/// Two segments are the same view if the rest of the sweep around them is the same: on the same beams of a robot that
/// stands, or on other beams of one that turned. So hours in front of one pillar count as one pillar. Things that come
/// and go on different beams while the robot stands are different views.
class DistinctViews {
 public:
  DistinctViews(const RangeSample& sample, const LevelWindow& window);

  /// Adds a sweep; `turn` counts in an order that is spread over the whole sample, so that any first part represents
  /// all.
  void add_sweep(std::size_t turn);

  double inside() const { return inside_.weight; }
  double below() const { return below_.weight; }
  double above() const { return above_.weight; }
  /// Says whether more sweeps would not change the decision.
  bool is_enough() const;

 private:
  struct View {
    std::size_t sweep = 0;
    double middle = 0.0;
    double num_beams = 0.0;
  };
  struct Zone {
    double weight = 0.0;
    std::vector<View> views;
  };
  struct Shares {
    double inside = 0.0;
    double below = 0.0;
    double above = 0.0;
  };

  Shares shares_of(const RangeSegment& segment) const;
  bool is_new(const Zone& zone, const View& view) const;
  struct Likeness {
    std::size_t compared = 0;
    std::size_t same = 0;
    double sum = 0.0;  ///< sum of the differences, as shares of the tolerance, at most 1 each
    double sum_of_squares = 0.0;
    bool is_alike() const;
    double mean() const { return sum / std::max<double>(1.0, static_cast<double>(compared)); }
    double variance_of_mean() const;
  };
  bool is_same(const View& a, const View& b) const;
  /// Compares two sweeps with beam `middle_a` of the one laid on beam `middle_b` of the other.
  Likeness likeness(const View& a, double middle_a, const View& b, double middle_b) const;
  bool is_inside(Millimetres range_mm) const { return range_mm >= window_.from_mm && range_mm < window_.end_mm; }

  const RangeSample& sample_;
  LevelWindow window_;
  Millimetres side_mm_ = 0;
  std::size_t stride_ = 1;
  Zone inside_;
  Zone below_;
  Zone above_;
};

}  // namespace shapemap
