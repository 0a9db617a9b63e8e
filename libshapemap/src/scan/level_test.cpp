// SPDX-License-Identifier: GPL-3.0-or-later
#include "level_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "distinct_views.hpp"

namespace shapemap {
namespace {

constexpr double kErrorPerSensor = 1e-6;
constexpr std::array<Millimetres, 2> kBeside{8, 24};  // more make the test stronger, but for levels among surfaces
constexpr Millimetres kNarrowest_mm = 2;
constexpr Millimetres kNearest_mm = 20;  // no laser measures surfaces that are nearer
constexpr Millimetres kWidest_mm = 512;  // spread levels are up to 0.2 m wide, and need not lie well in a window
constexpr double kWidestShare = 0.02;    // as a share of the distance: people who walk by would keep inside a wider one
constexpr Millimetres kCoarsest_mm = 64;  // steps of readings are up to 5 cm
constexpr double kEvenShare = 0.2;  // as a share of a side's weight, which is 1/8 where readings are spread evenly
constexpr double kQuantile = 0.25;  // levels may hold most of the weight, but not three quarters
constexpr std::size_t kMostCandidates = 24;  // in each round of the test
constexpr std::size_t kFirstStage = 64;      // in sweeps; each stage has four times as many as the one before
constexpr double kNumStages = 6;
constexpr double kSlack = 2.0;  // the remaining sweeps may say so many times more than those seen

/// Bounds the share that a window may hold of its own weight and that of the windows beside it. A wall that is seen
/// square-on reaches the bound.
double largest_share(const LevelWindow& window) {
  const double distant = 1.0 / std::sqrt(1.0 + window.num_beside);
  if (window.from_mm < kNearest_mm) return distant;
  const double of_width = window.width_mm() / static_cast<double>(window.from_mm);
  return std::acos(1.0 / (1.0 + of_width)) / std::acos(1.0 / (1.0 + (1.0 + window.num_beside) * of_width));
}

/// Returns the logarithm of a Chernoff bound of the probability that at least `inside` of `inside + beside` fall
/// inside.
double log_chernoff(double inside, double beside, const LevelWindow& window) {
  const double total = inside + beside;
  if (total <= 0.0 || inside * inside * (1.0 + window.num_beside) <= total * total) return 0.0;
  const double largest = largest_share(window);
  const double share = inside / total;
  if (share <= largest) return 0.0;
  const double rest = 1.0 - share;
  double divergence = share * std::log(share / largest);
  if (rest > 0.0) divergence += rest * std::log(rest / (1.0 - largest));
  return -total * divergence;
}

bool overlap(const LevelWindow& a, const LevelWindow& b) { return a.from_mm < b.end_mm && b.from_mm < a.end_mm; }

}  // namespace

LevelTest::LevelTest(RangeSample& sample) : sample_(sample) {
  add_up_weights();
  find_resolution();
}

void LevelTest::add_up_weights() {
  std::vector<double> weights(static_cast<std::size_t>(sample_.longest_mm()) + 1, 0.0);
  for (const RangeSegment& segment : sample_.segments()) {
    const Millimetres* readings_mm = sample_.readings(sample_.sweeps()[segment.sweep]);
    const double each = 1.0 / static_cast<double>(segment.num_readings);
    for (std::size_t beam = segment.first; beam <= segment.last; ++beam) {
      weights[static_cast<std::size_t>(readings_mm[beam])] += readings_mm[beam] > 0 ? each : 0.0;
    }
  }
  occupied_mm_.clear();
  weight_below_.assign(weights.size() + 1, 0.0);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weight_below_[i + 1] = weight_below_[i] + weights[i];
    if (weights[i] > 0.0) occupied_mm_.push_back(static_cast<Millimetres>(i));
  }
}

double LevelTest::weight(Millimetres from_mm, Millimetres end_mm) const {
  const auto highest = static_cast<Millimetres>(weight_below_.size()) - 1;
  return weight_below_[static_cast<std::size_t>(std::clamp(end_mm, 0, highest))] -
         weight_below_[static_cast<std::size_t>(std::clamp(from_mm, 0, highest))];
}

double LevelTest::denser_side(const LevelWindow& window) const {
  const Millimetres side_mm = window.num_beside * window.width_mm();
  return std::max(weight(window.from_mm - side_mm, window.from_mm), weight(window.end_mm, window.end_mm + side_mm));
}

bool LevelTest::is_even(Millimetres range_mm) const {
  const LevelWindow window{range_mm - resolution_mm_ / 2, range_mm + resolution_mm_ / 2, kBeside.front()};
  return weight(window.from_mm, window.end_mm) <= kEvenShare * denser_side(window);
}

void LevelTest::find_resolution() {
  for (resolution_mm_ = kNarrowest_mm; resolution_mm_ < kCoarsest_mm; resolution_mm_ *= 2) {
    double even = 0.0;
    for (const Millimetres range_mm : occupied_mm_) {
      if (is_even(range_mm)) even += weight(range_mm, range_mm + 1);
    }
    if (even >= kQuantile * weight_below_.back()) break;
  }
}

std::vector<LevelWindow> LevelTest::candidates() {
  std::vector<LevelWindow> all;
  num_windows_ = 1;
  const double step_rad = sample_.largest_step_rad();
  for (Millimetres width_mm = resolution_mm_; width_mm <= kWidest_mm; width_mm *= 2) {
    num_windows_ += kBeside.size() * occupied_mm_.size();
    for (const Millimetres from_mm : occupied_mm_) {
      // A few beams only see a wall square-on: the side has its share of them from this width on.
      if (width_mm < 0.25 * step_rad * step_rad * from_mm) break;
      if (width_mm > resolution_mm_ && width_mm > kWidestShare * from_mm) continue;
      for (const Millimetres num_beside : kBeside) {
        LevelWindow window{from_mm, from_mm + width_mm, num_beside};
        window.log_error = log_chernoff(weight(from_mm, window.end_mm), denser_side(window), window);
        if (window.log_error < std::log(kErrorPerSensor)) all.push_back(window);
      }
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const LevelWindow& a, const LevelWindow& b) {
    return a.log_error != b.log_error ? a.log_error < b.log_error : a.width_mm() < b.width_mm();
  });
  std::vector<LevelWindow> best;
  for (const LevelWindow& window : all) {
    if (best.size() == kMostCandidates) break;
    const auto meets = [&](const LevelWindow& other) { return overlap(window, other); };
    if (std::none_of(best.begin(), best.end(), meets)) best.push_back(window);
  }
  return best;
}

double LevelTest::allowed_log_error(const LevelWindow& window) const {
  const bool is_at_end = window.from_mm <= occupied_mm_.front() || window.end_mm > occupied_mm_.back();
  double count = static_cast<double>(num_windows_);
  if (is_at_end) {  // each width has a window at both ends
    count = 2.0 * static_cast<double>(kBeside.size());
    for (Millimetres width_mm = resolution_mm_; width_mm < kWidest_mm; width_mm *= 2) {
      count += 2.0 * static_cast<double>(kBeside.size());
    }
  }
  return std::log(0.5 * kErrorPerSensor / count / kNumStages);
}

bool LevelTest::is_level(LevelWindow& window) const {
  const double allowed = allowed_log_error(window);
  DistinctViews views(sample_, window);
  const std::size_t num_sweeps = sample_.sweeps().size();
  std::size_t stage_end = kFirstStage;
  for (std::size_t seen = 0; seen < num_sweeps;) {
    for (; seen < std::min(stage_end, num_sweeps); ++seen) views.add_sweep(seen);
    window.log_error = log_chernoff(views.inside(), std::max(views.below(), views.above()), window);
    if (window.log_error < allowed) return true;
    const double at_most = kSlack * window.log_error * static_cast<double>(num_sweeps) / static_cast<double>(seen);
    if (views.is_enough() || at_most > allowed) return false;  // views become rarer, not more frequent
    stage_end *= 4;
  }
  return false;
}

std::optional<LevelWindow> LevelTest::next() {
  add_up_weights();
  for (LevelWindow& window : candidates()) {
    const auto is_same = [&](const LevelWindow& other) {
      return other.from_mm == window.from_mm && other.end_mm == window.end_mm && other.num_beside == window.num_beside;
    };
    if (std::any_of(refuted_.begin(), refuted_.end(), is_same)) continue;
    if (is_level(window)) return window;
    refuted_.push_back(window);
  }
  return std::nullopt;
}

}  // namespace shapemap
