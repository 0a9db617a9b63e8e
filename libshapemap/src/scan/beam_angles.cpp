// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapemap/scan/beam_angles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "shapemap/core/angles.hpp"

namespace shapemap {
namespace {

constexpr double kTurn_rad = 2.0 * kPi;
constexpr double kRounding = 1e-3;          // headers hold 32-bit floats, or a few decimals
constexpr double kStepsOfDifference = 1.5;  // a full circle has its first beam twice, once, or not quite

/// A span may exceed a turn by rounding, and by the step of a last beam that closes the circle.
bool is_within_a_turn(double span_rad, double step_rad) {
  return std::abs(span_rad) <= kTurn_rad * (1.0 + kRounding) + std::abs(step_rad);
}

std::optional<double> usable_step_rad(const StatedAngles& stated, double num_steps) {
  if (!stated.step_rad || !std::isfinite(*stated.step_rad) || *stated.step_rad == 0.0) return std::nullopt;
  if (!is_within_a_turn(*stated.step_rad * num_steps, *stated.step_rad)) return std::nullopt;
  return stated.step_rad;
}

std::optional<double> usable_span_rad(const StatedAngles& stated) {
  if (!stated.last_rad || !std::isfinite(*stated.last_rad)) return std::nullopt;
  const double span_rad = *stated.last_rad - stated.first_rad;
  if (span_rad == 0.0 || !is_within_a_turn(span_rad, 0.0)) return std::nullopt;
  return span_rad;
}

/// Returns the median distance between neighbouring angles, without distances of 0.
double typical_spacing_rad(std::vector<double> angles_rad) {
  std::sort(angles_rad.begin(), angles_rad.end());
  std::vector<double> spacings_rad;
  for (std::size_t i = 1; i < angles_rad.size(); ++i) {
    const double spacing_rad = angles_rad[i] - angles_rad[i - 1];
    if (spacing_rad > 0.0) spacings_rad.push_back(spacing_rad);
  }
  if (spacings_rad.empty()) return 0.0;
  const auto middle = spacings_rad.begin() + static_cast<std::ptrdiff_t>(spacings_rad.size() / 2);
  std::nth_element(spacings_rad.begin(), middle, spacings_rad.end());
  return *middle;
}

bool runs_clockwise(const std::vector<double>& angles_rad) {
  std::ptrdiff_t ups = 0;
  for (std::size_t i = 1; i < angles_rad.size(); ++i) ups += angles_rad[i] >= angles_rad[i - 1] ? 1 : -1;
  return ups < 0;
}

}  // namespace

std::optional<EvenBeams> even_beams(const StatedAngles& stated, std::size_t num_beams) {
  if (!std::isfinite(stated.first_rad)) return std::nullopt;
  const double num_steps = std::max(1.0, static_cast<double>(num_beams) - 1.0);
  const std::optional<double> step_rad = usable_step_rad(stated, num_steps);
  const std::optional<double> span_rad = usable_span_rad(stated);
  if (num_beams < 2) return EvenBeams{stated.first_rad, step_rad.value_or(0.0), AngleSource::kAsStated};
  if (!step_rad && !span_rad) return std::nullopt;
  if (!step_rad) {
    const AngleSource source = stated.step_rad ? AngleSource::kLimits : AngleSource::kAsStated;
    return EvenBeams{stated.first_rad, *span_rad / num_steps, source};
  }
  if (!span_rad) {
    return EvenBeams{stated.first_rad, *step_rad, stated.last_rad ? AngleSource::kStep : AngleSource::kAsStated};
  }
  if ((*step_rad < 0.0) != (*span_rad < 0.0)) {
    return EvenBeams{stated.first_rad, *span_rad / num_steps, AngleSource::kLimits};
  }
  const bool agree = std::abs(*step_rad * num_steps - *span_rad) <= kStepsOfDifference * std::abs(*step_rad);
  return EvenBeams{stated.first_rad, *step_rad, agree ? AngleSource::kAsStated : AngleSource::kStep};
}

void set_beam_angles(Sweep& sweep, std::vector<double> angles_rad) {
  sweep.first_angle_rad = angles_rad.empty() ? 0.0 : angles_rad.front();
  sweep.angle_step_rad =
      runs_clockwise(angles_rad) ? -typical_spacing_rad(angles_rad) : typical_spacing_rad(angles_rad);
  sweep.beam_angles_rad = std::move(angles_rad);
}

Sweep on_even_beams(const Sweep& sweep) {
  if (sweep.is_evenly_spaced()) return sweep;
  Sweep even = sweep;
  even.beam_angles_rad.clear();
  even.beam_times_s.clear();
  even.intensities.clear();
  even.beam_time_step_s = 0.0;
  const double step_rad = std::abs(sweep.angle_step_rad);
  const auto [lowest, highest] = std::minmax_element(sweep.beam_angles_rad.begin(), sweep.beam_angles_rad.end());
  even.first_angle_rad = *lowest;
  even.angle_step_rad = step_rad;
  const double span_rad = std::min(*highest - *lowest, kTurn_rad);
  const auto last = static_cast<std::size_t>(step_rad > 0.0 ? std::lround(span_rad / step_rad) : 0);
  even.ranges_m.assign(last + 1, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < sweep.ranges_m.size(); ++i) {
    const double steps = step_rad > 0.0 ? (sweep.beam_angles_rad[i] - *lowest) / step_rad : 0.0;
    float& range_m = even.ranges_m[std::min(last, static_cast<std::size_t>(std::lround(steps)))];
    const float reading_m = sweep.ranges_m[i];
    if (std::isnan(range_m) || (reading_m > 0.0F && reading_m < range_m)) range_m = reading_m;
  }
  return even;
}

}  // namespace shapemap
