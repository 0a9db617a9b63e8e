// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shapemap/scan/scan.hpp"

namespace shapemap {

/// Distances are counted in whole millimetres here; 0 is no distance.
using Millimetres = std::int32_t;

Millimetres to_mm(float range_m, const Sweep& sweep);

/// Returns the mean angle between neighbouring beams, which is never 0.
double beam_step_rad(const Sweep& sweep);

/// Returns by how much two readings, `num_beams` beams apart, may differ if one surface continues from one to the
/// other.
Millimetres continuity_mm(Millimetres range_mm, double step_rad, std::size_t num_beams, double noise_mm);

/// In a sensor that nothing is known of, two readings of one surface differ by at most so much.
inline constexpr double kUsualNoise_mm = 50.0;

/// A range segment is a run of neighbouring beams of one sweep whose readings continue each other: the part of one
/// surface that is seen.
struct RangeSegment {
  std::size_t sweep = 0;
  std::size_t first = 0;
  std::size_t last = 0;  ///< the last beam is inclusive
  std::size_t num_readings = 0;
  Millimetres nearest_mm = 0;
  Millimetres farthest_mm = 0;

  double middle() const { return 0.5 * static_cast<double>(first + last); }
};

/// A sample is an even choice of sweeps of one sensor, cut into segments.
class RangeSample {
 public:
  explicit RangeSample(const std::vector<Sweep*>& sweeps);

  /// Declares that these readings are no distances, and cuts the sweeps into segments anew.
  void remove(Millimetres from_mm, Millimetres to_mm);

  struct SampledSweep {
    std::size_t begin = 0;  ///< index of the first of its readings
    std::size_t size = 0;
    double step_rad = 0.0;
    bool is_closed = false;  ///< the last beam is the neighbour of the first
    std::size_t first_segment = 0;
    std::size_t end_segment = 0;
  };
  const std::vector<SampledSweep>& sweeps() const { return sweeps_; }
  const std::vector<RangeSegment>& segments() const { return segments_; }
  const Millimetres* readings(const SampledSweep& sweep) const { return ranges_mm_.data() + sweep.begin; }
  Millimetres longest_mm() const { return longest_mm_; }
  double largest_step_rad() const { return largest_step_rad_; }

 private:
  void estimate_noise();
  void cut_into_segments();
  void cut(std::size_t index);

  std::vector<Millimetres> ranges_mm_;
  std::vector<SampledSweep> sweeps_;
  std::vector<RangeSegment> segments_;
  Millimetres longest_mm_ = 0;
  double largest_step_rad_ = 0.0;
  double noise_mm_ = kUsualNoise_mm;
};

}  // namespace shapemap
