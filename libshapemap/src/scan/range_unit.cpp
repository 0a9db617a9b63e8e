// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/range_unit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace shapemap {
namespace {

constexpr double kFarthestMiddle_m = 100.0;

/// The usual range, the nearest range and the roughness are log-normal, each with a median and a factor of spread. The
/// numbers are those of rooms, and of the noise of lasers.
constexpr double kUsualRange_m = 5.0;
constexpr double kRangeFactor = 3.0;
constexpr double kUsualNearest_m = 0.6;
constexpr double kNearestFactor = 4.0;
/// The roughness is that of the smoothest tenth, about 0.3 times the noise of a reading.
constexpr double kUsualRoughness_m = 0.0025;
constexpr double kRoughnessFactor = 2.5;

/// No sensor measures nearer, so a smaller limit was in metres.
constexpr double kLeastMinRange_m = 0.01;

/// So many scans, spread over the log, are enough to tell.
constexpr std::size_t kMostScans = 400;

/// Returns the value that `share` of the values are below; 0 when there are none.
double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

bool is_reading(float range) { return std::isfinite(range) && range > 0.0F; }

struct Readings {
  double middle = 0.0;   ///< median of the distances that occur
  double nearest = 0.0;  ///< nearest of them, but for one of a hundred
  /// The deviation of the smoothest surfaces from straight, beam by beam; it is at least half a step of the readings.
  double roughness = 0.0;
};

Readings readings_of(const Log& log) {
  std::vector<double> ranges;
  std::vector<double> bends;
  const std::size_t stride = std::max<std::size_t>(1, log.scans.size() / kMostScans);
  for (std::size_t i = 0; i < log.scans.size(); i += stride) {
    for (const Sweep& sweep : log.scans[i].sweeps) {
      const std::vector<float>& r = sweep.ranges_m;
      for (std::size_t k = 0; k < r.size(); ++k) {
        if (!is_reading(r[k])) continue;
        ranges.push_back(r[k]);
        if (k == 0 || k + 1 == r.size() || !is_reading(r[k - 1]) || !is_reading(r[k + 1])) continue;
        bends.push_back(std::abs(static_cast<double>(r[k - 1]) - 2.0 * r[k] + r[k + 1]));
      }
    }
  }
  double step = std::numeric_limits<double>::infinity();
  // Each distance counts once, so that a code for "no return" has no weight, however often it occurs.
  std::sort(ranges.begin(), ranges.end());
  ranges.erase(std::unique(ranges.begin(), ranges.end()), ranges.end());
  for (std::size_t i = 1; i < ranges.size(); ++i) step = std::min(step, ranges[i] - ranges[i - 1]);
  const double hidden = ranges.size() > 1 ? 0.5 * step : 0.0;
  return {quantile(ranges, 0.5), quantile(ranges, 0.01), std::max(quantile(bends, 0.1), hidden)};
}

double unusual(double value, double usual, double factor) {
  const double widths = std::log(value / usual) / std::log(factor);
  return 0.5 * widths * widths;
}

/// Returns the log density of a log under a unit, up to a constant that all units share.
double log_density(const Readings& readings, RangeUnit unit) {
  const double scale = metres_per(unit);
  return -unusual(readings.middle * scale, kUsualRange_m, kRangeFactor) -
         unusual(readings.nearest * scale, kUsualNearest_m, kNearestFactor) -
         unusual(readings.roughness * scale, kUsualRoughness_m, kRoughnessFactor);
}

}  // namespace

double metres_per(RangeUnit unit) {
  if (unit == RangeUnit::kMillimetre) return 0.001;
  return unit == RangeUnit::kCentimetre ? 0.01 : 1.0;
}

RangeUnit recognised_range_unit(const Log& log) {
  const Readings readings = readings_of(log);
  if (!(readings.middle > kFarthestMiddle_m)) return RangeUnit::kMetre;
  const bool is_cm = log_density(readings, RangeUnit::kCentimetre) > log_density(readings, RangeUnit::kMillimetre);
  return is_cm ? RangeUnit::kCentimetre : RangeUnit::kMillimetre;
}

void scale_ranges(Log& log, RangeUnit unit) {
  const double scale = metres_per(unit);
  if (scale == 1.0) return;
  const double middle = readings_of(log).middle;
  for (Scan& scan : log.scans) {
    for (Sweep& sweep : scan.sweeps) {
      for (float& range : sweep.ranges_m) range = static_cast<float>(range * scale);
      if (sweep.max_range_m >= middle) sweep.max_range_m *= scale;
      if (sweep.min_range_m * scale >= kLeastMinRange_m) sweep.min_range_m *= scale;
    }
  }
}

}  // namespace shapemap
