// SPDX-License-Identifier: GPL-3.0-or-later
#include "range_sample.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "shapemap/scan/returns.hpp"

namespace shapemap {
namespace {

constexpr std::size_t kMostSampled = 400'000;  // in readings: a level on 0.1 % of them is still seen 400 times
constexpr std::size_t kFewestSweeps = 1000;    // so many views are kept even of sensors with a great many beams
constexpr double kSteepest = 2.0;              // tangent of the angle of incidence that still counts as one surface
constexpr double kMostOfRange = 0.1;           // as a share of the range, for widely spaced beams
constexpr double kMostNoise_mm = 300.0;        // four standard deviations of a difference, where readings have 5 cm
constexpr double kNoisePerBend = 3.5;          // four standard deviations, by the median of second differences
constexpr std::size_t kFewestBends = 100;
constexpr std::size_t kMostBridged = 8;  // a segment continues over so many beams without a reading

}  // namespace

Millimetres to_mm(float range_m, const Sweep& sweep) {
  if (!(range_m > 0.0F && range_m < static_cast<float>(kLongestRange_m))) return 0;  // the comparison is false for NaN
  if (range_m < static_cast<float>(sweep.min_range_m)) return 0;
  return static_cast<Millimetres>(range_m * 1000.0F + 0.5F);
}

double beam_step_rad(const Sweep& sweep) {
  const std::size_t num_beams = sweep.ranges_m.size();
  if (num_beams < 2) return 2 * kPi;
  const double step_rad = std::abs(sweep.angle_step_rad);
  const double widest_rad = 2 * kPi / static_cast<double>(num_beams - 1);
  return step_rad > 0.0 && step_rad <= widest_rad ? step_rad : widest_rad;
}

Millimetres continuity_mm(Millimetres range_mm, double step_rad, std::size_t num_beams, double noise_mm) {
  const double share = std::min(kSteepest * step_rad * static_cast<double>(num_beams), kMostOfRange);
  return static_cast<Millimetres>(share * range_mm + noise_mm);
}

RangeSample::RangeSample(const std::vector<Sweep*>& sweeps) {
  std::size_t num_readings = 0;
  for (const Sweep* sweep : sweeps) num_readings += sweep->ranges_m.size();
  const std::size_t mean_beams = std::max<std::size_t>(1, num_readings / std::max<std::size_t>(1, sweeps.size()));
  const std::size_t wanted = std::min(sweeps.size(), std::max(kFewestSweeps, kMostSampled / mean_beams));
  for (std::size_t i = 0; i < wanted; ++i) {
    const Sweep& sweep = *sweeps[i * sweeps.size() / wanted];
    SampledSweep sampled;
    sampled.begin = ranges_mm_.size();
    sampled.size = sweep.ranges_m.size();
    sampled.step_rad = beam_step_rad(sweep);
    sampled.is_closed = sampled.step_rad * (static_cast<double>(sampled.size) + 1.0) > 2 * kPi;
    for (const float range_m : sweep.ranges_m) ranges_mm_.push_back(to_mm(range_m, sweep));
    largest_step_rad_ = std::max(largest_step_rad_, sampled.step_rad);
    sweeps_.push_back(sampled);
  }
  for (const Millimetres range_mm : ranges_mm_) longest_mm_ = std::max(longest_mm_, range_mm);
  estimate_noise();
  cut_into_segments();
}

void RangeSample::estimate_noise() {
  std::vector<Millimetres> bends_mm;
  for (const SampledSweep& sweep : sweeps_) {
    const Millimetres* readings_mm = readings(sweep);
    for (std::size_t beam = 2; beam < sweep.size; beam += 3) {
      const Millimetres a_mm = readings_mm[beam - 2];
      const Millimetres b_mm = readings_mm[beam - 1];
      const Millimetres c_mm = readings_mm[beam];
      if (a_mm > 0 && b_mm > 0 && c_mm > 0 && (a_mm != b_mm || b_mm != c_mm))
        bends_mm.push_back(std::abs(a_mm - 2 * b_mm + c_mm));
    }
  }
  if (bends_mm.size() < kFewestBends) return;
  const auto middle = bends_mm.begin() + static_cast<std::ptrdiff_t>(bends_mm.size() / 2);
  std::nth_element(bends_mm.begin(), middle, bends_mm.end());
  noise_mm_ = std::clamp(kNoisePerBend * *middle, kUsualNoise_mm, kMostNoise_mm);
}

void RangeSample::remove(Millimetres from_mm, Millimetres to_mm) {
  for (Millimetres& range_mm : ranges_mm_) {
    if (range_mm >= from_mm && range_mm <= to_mm) range_mm = 0;
  }
  cut_into_segments();
}

void RangeSample::cut_into_segments() {
  segments_.clear();
  for (std::size_t i = 0; i < sweeps_.size(); ++i) {
    sweeps_[i].first_segment = segments_.size();
    cut(i);
    sweeps_[i].end_segment = segments_.size();
  }
}

void RangeSample::cut(std::size_t index) {
  const SampledSweep& sweep = sweeps_[index];
  const Millimetres* readings_mm = readings(sweep);
  RangeSegment current;
  for (std::size_t beam = 0; beam < sweep.size; ++beam) {
    const Millimetres range_mm = readings_mm[beam];
    if (range_mm == 0) continue;
    if (current.num_readings > 0) {
      const std::size_t gap = beam - current.last;
      const Millimetres before_mm = readings_mm[current.last];
      if (gap <= kMostBridged + 1 && std::abs(range_mm - before_mm) <=
                                         continuity_mm(std::min(range_mm, before_mm), sweep.step_rad, gap, noise_mm_)) {
        current.last = beam;
        ++current.num_readings;
        current.nearest_mm = std::min(current.nearest_mm, range_mm);
        current.farthest_mm = std::max(current.farthest_mm, range_mm);
        continue;
      }
      segments_.push_back(current);
    }
    current = {index, beam, beam, 1, range_mm, range_mm};
  }
  if (current.num_readings > 0) segments_.push_back(current);
}

}  // namespace shapemap
