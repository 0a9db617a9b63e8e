// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "range_sample.hpp"

namespace shapemap {

/// The distances from `from_mm` up to, but without, `end_mm`, on which suspiciously many range segments lie.
struct LevelWindow {
  Millimetres from_mm = 0;
  Millimetres end_mm = 0;
  Millimetres num_beside = 0;  ///< number of widths on each side that it is compared with
  double log_error = 0.0;      ///< bound of the logarithm of the probability that real surfaces look like this
  Millimetres width_mm() const { return end_mm - from_mm; }
};

/// Looks for distances at which there are more range segments than surfaces can make, in a sample of one sensor's
/// sweeps.
///
/// The null hypothesis is that segments are surfaces. Each has a weight of one, spread over its readings. In the
/// densest case, a flat wall seen square-on from d, the beams between d and d + w span an angle of sqrt(2 w / d), and
/// those from d to d + (n + 1) w one of sqrt(2 (n + 1) w / d): of a window and the n windows on its denser side, the
/// window holds at most a share of 1 / sqrt(n + 1) (somewhat more where w is not small beside d). The independent units
/// are segments in views that differ; turning on the spot or standing makes no new view. The Chernoff bound in
/// Hoeffding's form (1963) judges by how much the share is exceeded. Half of the allowed error is for windows at the
/// shortest and the longest readings, where levels usually are.
class LevelTest {
 public:
  explicit LevelTest(RangeSample& sample);

  /// Returns the most improbable window that refutes the null hypothesis, if there is one. The caller removes its
  /// readings from the sample before it asks again.
  std::optional<LevelWindow> next();

  /// Returns the narrowest window in which the readings of real surfaces are spread evenly in spite of their
  /// quantisation.
  Millimetres resolution_mm() const { return resolution_mm_; }

 private:
  void add_up_weights();
  void find_resolution();
  double weight(Millimetres from_mm, Millimetres end_mm) const;
  double denser_side(const LevelWindow& window) const;
  bool is_even(Millimetres range_mm) const;
  double allowed_log_error(const LevelWindow& window) const;
  std::vector<LevelWindow> candidates();
  bool is_level(LevelWindow& window) const;

  RangeSample& sample_;
  std::vector<double> weight_below_;  ///< weight of all distances below an index in millimetres
  std::vector<Millimetres> occupied_mm_;
  Millimetres resolution_mm_ = 0;
  std::size_t num_windows_ = 0;
  std::vector<LevelWindow> refuted_;
};

}  // namespace shapemap
