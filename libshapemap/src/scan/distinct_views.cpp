// SPDX-License-Identifier: GPL-3.0-or-later
#include "distinct_views.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace shapemap {
namespace {

constexpr std::size_t kComparedBeams = 128;
constexpr std::size_t kFewestCompared = 8;  // a view with fewer compared beams counts as seen before
constexpr double kSameShare = 0.4;     // share of equal readings: people may walk through a view that stays the same
constexpr double kSame_mm = 50.0;      // this is the noise of the roughest sensors, and
constexpr double kSameOfRange = 0.05;  // the robot must have moved by this share of the range
constexpr double kClearly = 3.0;       // standard deviations by which a robot rather stood than turned
constexpr std::size_t kEnoughViews = 512;  // of one zone
constexpr std::size_t kGlance = 16;        // if none of so many readings are equal, no more are compared

}  // namespace

DistinctViews::DistinctViews(const RangeSample& sample, const LevelWindow& window)
    : sample_(sample), window_(window), side_mm_(window.num_beside * window.width_mm()) {
  const std::size_t num_sweeps = std::max<std::size_t>(1, sample.sweeps().size());
  stride_ = std::max<std::size_t>(1, static_cast<std::size_t>(0.618 * static_cast<double>(num_sweeps)));
  while (std::gcd(stride_, num_sweeps) != 1) ++stride_;
}

bool DistinctViews::is_enough() const {
  return std::max({inside_.views.size(), below_.views.size(), above_.views.size()}) >= kEnoughViews;
}

void DistinctViews::add_sweep(std::size_t turn) {
  const RangeSample::SampledSweep& sweep = sample_.sweeps()[turn * stride_ % sample_.sweeps().size()];
  for (std::size_t i = sweep.first_segment; i < sweep.end_segment; ++i) {
    const RangeSegment& segment = sample_.segments()[i];
    if (segment.farthest_mm < window_.from_mm - side_mm_ || segment.nearest_mm >= window_.end_mm + side_mm_) continue;
    const Shares shares = shares_of(segment);
    const double most = std::max({shares.inside, shares.below, shares.above});
    if (most <= 0.0) continue;
    Zone& zone = shares.inside == most ? inside_ : shares.below == most ? below_ : above_;
    const View view{segment.sweep, segment.middle(), static_cast<double>(segment.last - segment.first + 1)};
    if (is_enough() || !is_new(zone, view)) continue;
    zone.views.push_back(view);
    inside_.weight += shares.inside;
    below_.weight += shares.below;
    above_.weight += shares.above;
  }
}

DistinctViews::Shares DistinctViews::shares_of(const RangeSegment& segment) const {
  const Millimetres* readings_mm = sample_.readings(sample_.sweeps()[segment.sweep]);
  const double each = 1.0 / static_cast<double>(segment.num_readings);
  Shares shares;
  for (std::size_t beam = segment.first; beam <= segment.last; ++beam) {
    const Millimetres range_mm = readings_mm[beam];
    if (range_mm == 0 || range_mm < window_.from_mm - side_mm_ || range_mm >= window_.end_mm + side_mm_) continue;
    (is_inside(range_mm) ? shares.inside : range_mm < window_.from_mm ? shares.below : shares.above) += each;
  }
  return shares;
}

bool DistinctViews::is_new(const Zone& zone, const View& view) const {
  return std::none_of(zone.views.rbegin(), zone.views.rend(), [&](const View& known) { return is_same(known, view); });
}

bool DistinctViews::Likeness::is_alike() const {
  return compared < kFewestCompared || static_cast<double>(same) >= kSameShare * static_cast<double>(compared);
}

double DistinctViews::Likeness::variance_of_mean() const {
  const auto count = std::max<double>(1.0, static_cast<double>(compared));
  return std::max(0.0, sum_of_squares / count - mean() * mean()) / count;
}

bool DistinctViews::is_same(const View& a, const View& b) const {
  const double step_rad = sample_.sweeps()[b.sweep].step_rad;
  const double middle_of_b = b.middle * step_rad / sample_.sweeps()[a.sweep].step_rad;  // counted in beams of a
  if (std::abs(a.middle - middle_of_b) < 0.5 * (a.num_beams + b.num_beams)) {
    if (likeness(a, middle_of_b, b, b.middle).is_alike()) return true;
  }
  const Likeness turned = likeness(a, a.middle, b, b.middle);
  if (!turned.is_alike()) return false;
  const Likeness standing = likeness(a, middle_of_b, b, b.middle);
  const double deviation = std::sqrt(standing.variance_of_mean() + turned.variance_of_mean());
  return !standing.is_alike() || turned.mean() - standing.mean() <= kClearly * deviation;
}

DistinctViews::Likeness DistinctViews::likeness(const View& a, double middle_a, const View& b, double middle_b) const {
  const RangeSample::SampledSweep& of_a = sample_.sweeps()[a.sweep];
  const RangeSample::SampledSweep& of_b = sample_.sweeps()[b.sweep];
  const Millimetres* of_a_mm = sample_.readings(of_a);
  const Millimetres* of_b_mm = sample_.readings(of_b);
  const double a_per_b = of_b.step_rad / of_a.step_rad;
  const auto size_of_a = static_cast<std::ptrdiff_t>(of_a.size);
  const std::size_t count = std::min(kComparedBeams, of_b.size);
  Likeness likeness;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t in_b = i * of_b.size / count;
    auto in_a = std::lround(middle_a + (static_cast<double>(in_b) - middle_b) * a_per_b);
    if (of_a.is_closed) in_a = (in_a % size_of_a + size_of_a) % size_of_a;
    if (in_a < 0 || in_a >= size_of_a) continue;
    const Millimetres a_mm = of_a_mm[in_a];
    const Millimetres b_mm = of_b_mm[in_b];
    if (a_mm == 0 || b_mm == 0 || (is_inside(a_mm) && is_inside(b_mm))) continue;
    if (likeness.compared == kGlance && likeness.same == 0) return likeness;
    ++likeness.compared;
    const double difference = std::abs(a_mm - b_mm) / (kSame_mm + kSameOfRange * std::min(a_mm, b_mm));
    likeness.sum += std::min(difference, 1.0);
    likeness.sum_of_squares += std::min(difference, 1.0) * std::min(difference, 1.0);
    if (difference <= 1.0) ++likeness.same;
  }
  return likeness;
}

}  // namespace shapemap
