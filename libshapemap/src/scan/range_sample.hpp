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

/// The mean angle between neighbouring beams, never 0.
double beam_step_rad(const Sweep& sweep);

/// By how much two readings may differ that `num_beams` lie between, if one surface goes on from one to the other.
Millimetres continuity_mm(Millimetres range_mm, double step_rad, std::size_t num_beams, double noise_mm);

/// Of the difference of two readings of one surface, at most, in a sensor that nothing is known of.
inline constexpr double kUsualNoise_mm = 50.0;

/// A run of neighbouring beams of one sweep whose readings continue each other: what is seen of one surface.
struct Fragment {
  std::size_t sweep = 0;
  std::size_t first = 0;
  std::size_t last = 0;  ///< inclusive
  std::size_t num_readings = 0;
  Millimetres nearest_mm = 0;
  Millimetres farthest_mm = 0;

  double middle() const { return 0.5 * static_cast<double>(first + last); }
};

/// Evenly chosen sweeps of one sensor, cut into fragments.
class RangeSample {
 public:
  explicit RangeSample(const std::vector<Sweep*>& sweeps);

  /// These readings are known to be no distances from now on.
  void remove(Millimetres from_mm, Millimetres to_mm);

  struct SampledSweep {
    std::size_t begin = 0;  ///< of its readings
    std::size_t size = 0;
    double step_rad = 0.0;
    bool is_closed = false;  ///< the last beam is the neighbour of the first
    std::size_t first_fragment = 0;
    std::size_t end_fragment = 0;
  };
  const std::vector<SampledSweep>& sweeps() const { return sweeps_; }
  const std::vector<Fragment>& fragments() const { return fragments_; }
  const Millimetres* readings(const SampledSweep& sweep) const { return ranges_mm_.data() + sweep.begin; }
  Millimetres longest_mm() const { return longest_mm_; }
  double largest_step_rad() const { return largest_step_rad_; }

 private:
  void estimate_noise();
  void cut_into_fragments();
  void cut(std::size_t index);

  std::vector<Millimetres> ranges_mm_;
  std::vector<SampledSweep> sweeps_;
  std::vector<Fragment> fragments_;
  Millimetres longest_mm_ = 0;
  double largest_step_rad_ = 0.0;
  double noise_mm_ = kUsualNoise_mm;
};

}  // namespace shapemap
