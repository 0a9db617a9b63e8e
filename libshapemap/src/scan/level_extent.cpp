// SPDX-License-Identifier: GPL-3.0-or-later
#include "level_extent.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace shapemap {
namespace {

constexpr double kFewestOfLevel = 0.002;  // rarer distances are odd readings beside a level
constexpr double kTimesAround = 2.5;      // surfaces may be so many times denser than what is around
constexpr double kSigmas = 5.0;           // a distance of a level has so many more readings than those around
constexpr double kMostOfLevel = 0.9;      // single distances make so much of a level, or it is spread evenly
constexpr Millimetres kBeside = 8;        // so many widths on each side tell what is usual

/// Counts how often each distance around a window was read.
class Readings {
 public:
  Readings(const std::vector<Sweep*>& sweeps, const LevelWindow& window, Millimetres reach_mm)
      : window_(window), first_mm_(window.from_mm - reach_mm) {
    counts_.assign(static_cast<std::size_t>(window.width_mm() + 2 * reach_mm), 0.0);
    for (const Sweep* sweep : sweeps) {
      for (const float range_m : sweep->ranges_m) {
        const Millimetres range_mm = to_mm(range_m, *sweep);
        const Millimetres at = range_mm - first_mm_;
        if (range_mm > 0 && at >= 0 && at < static_cast<Millimetres>(counts_.size())) ++counts_[index(at)];
      }
    }
  }

  Millimetres first_mm() const { return first_mm_; }
  Millimetres end_mm() const { return first_mm_ + static_cast<Millimetres>(counts_.size()); }
  double count(Millimetres range_mm) const {
    return range_mm < first_mm_ || range_mm >= end_mm() ? 0.0 : counts_[index(range_mm - first_mm_)];
  }
  double count(Millimetres from_mm, Millimetres end_mm) const {
    double sum = 0.0;
    for (Millimetres range_mm = from_mm; range_mm < end_mm; ++range_mm) sum += count(range_mm);
    return sum;
  }
  /// Returns the most frequent distance of the window.
  Millimetres fullest() const {
    Millimetres fullest_mm = window_.from_mm;
    for (Millimetres range_mm = window_.from_mm; range_mm < window_.end_mm; ++range_mm) {
      if (count(range_mm) > count(fullest_mm)) fullest_mm = range_mm;
    }
    return fullest_mm;
  }
  /// Returns what an interval of `width_mm` usually holds on the denser side; the rest of a level may be on one of
  /// them.
  double usual_beside(Millimetres width_mm) const {
    return std::max(median_count(first_mm_, window_.from_mm, width_mm),
                    median_count(window_.end_mm, end_mm(), width_mm));
  }

 private:
  double median_count(Millimetres from_mm, Millimetres end_mm, Millimetres width_mm) const {
    std::vector<double> counts;
    for (; from_mm + width_mm <= end_mm; from_mm += width_mm) counts.push_back(count(from_mm, from_mm + width_mm));
    if (counts.empty()) return 0.0;
    const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
    std::nth_element(counts.begin(), middle, counts.end());
    return *middle;
  }
  static std::size_t index(Millimetres at) { return static_cast<std::size_t>(at); }

  LevelWindow window_;
  Millimetres first_mm_ = 0;
  std::vector<double> counts_;
};

}  // namespace

LevelExtent extent_of(const std::vector<Sweep*>& sweeps, const LevelWindow& window, Millimetres resolution_mm) {
  const Millimetres gap_mm = std::max(resolution_mm, window.width_mm());
  const Readings readings(sweeps, window, kBeside * gap_mm);
  const double in_window = readings.count(window.from_mm, window.end_mm);
  const double around = readings.usual_beside(resolution_mm);  // all readings of an interval may lie on one distance
  const double fewest = std::max(kTimesAround * around + kSigmas * std::sqrt(around) + 1.0, kFewestOfLevel * in_window);

  double of_single = 0.0;
  for (Millimetres range_mm = window.from_mm; range_mm < window.end_mm; ++range_mm) {
    if (readings.count(range_mm) > fewest) of_single += readings.count(range_mm);
  }
  const bool is_spread = of_single < kMostOfLevel * (in_window - around * window.width_mm() / resolution_mm);
  const auto stands_out = [&](Millimetres range_mm) {
    if (readings.count(range_mm) == 0.0) return false;
    const Millimetres half_mm = resolution_mm / 2;
    const double count =
        is_spread ? readings.count(range_mm - half_mm, range_mm + half_mm + 1) : readings.count(range_mm);
    return count > fewest;
  };

  LevelExtent extent{window.end_mm, window.from_mm - 1};
  for (Millimetres range_mm = window.from_mm; range_mm < window.end_mm; ++range_mm) {
    if (!stands_out(range_mm)) continue;
    extent.from_mm = std::min(extent.from_mm, range_mm);
    extent.to_mm = range_mm;
  }
  if (extent.to_mm < extent.from_mm) extent.from_mm = extent.to_mm = readings.fullest();
  for (Millimetres range_mm = extent.to_mm + 1; range_mm <= extent.to_mm + resolution_mm; ++range_mm) {
    if (range_mm < readings.end_mm() && stands_out(range_mm)) extent.to_mm = range_mm;
  }
  for (Millimetres range_mm = extent.from_mm - 1; range_mm >= extent.from_mm - resolution_mm; --range_mm) {
    if (range_mm >= readings.first_mm() && stands_out(range_mm)) extent.from_mm = range_mm;
  }
  return extent;
}

}  // namespace shapemap
