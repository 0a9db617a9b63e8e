// SPDX-License-Identifier: GPL-3.0-or-later
#include "no_return_level.hpp"

#include <cmath>

#include "carmen.hpp"

namespace shapemap {
namespace {

constexpr double kSickLimit_m = kLongestFlaserRange_m;
constexpr double kLowestLevel_m = 7.9;
constexpr double kFirstCodeIn4mm_m = 32.73;
constexpr double kLastCodeIn4mm_m = 32.77;
constexpr std::size_t kFewestOnLevel = 10;
constexpr std::size_t kTimesMoreThanBelow = 5;

bool is_round(double range_m) { return std::abs(range_m * 10.0 - std::round(range_m * 10.0)) < 1e-3; }

/// The lowest distance that belongs to the same level as `top_m`; 0 when `top_m` is no level.
double level_begin_m(double top_m) {
  if (top_m >= kFirstCodeIn4mm_m && top_m <= kLastCodeIn4mm_m) return kFirstCodeIn4mm_m;
  return is_round(top_m) ? top_m - 5e-4 : 0.0;
}

}  // namespace

void NoReturnLevel::add(const std::vector<float>& ranges_m) {
  for (const float range_m : ranges_m) {
    if (range_m >= kLowestLevel_m && range_m < kSickLimit_m) ++far_readings_[range_m];
  }
}

double NoReturnLevel::max_range_m() const {
  if (far_readings_.empty()) return kSickLimit_m;
  const double top_m = far_readings_.rbegin()->first;
  const double begin_m = level_begin_m(top_m);
  if (begin_m <= 0.0) return kSickLimit_m;

  double lowest_on_level_m = top_m;
  std::size_t num_on_level = 0;
  std::size_t num_below = 0;
  for (auto it = far_readings_.lower_bound(static_cast<float>(0.99 * top_m)); it != far_readings_.end(); ++it) {
    if (it->first < begin_m) {
      num_below += it->second;
      continue;
    }
    if (num_on_level == 0) lowest_on_level_m = it->first;
    num_on_level += it->second;
  }
  const bool is_level = num_on_level >= kFewestOnLevel && num_on_level > kTimesMoreThanBelow * num_below;
  return is_level ? lowest_on_level_m : kSickLimit_m;
}

}  // namespace shapemap
